#include "sweep/spool/spool.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/files/descriptor.hpp"
#include "sweep/files/locked_files.hpp"
#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <utility>

namespace grainsweep::spool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view campaign_head = "grainsweep spool 1\n";
constexpr double touches_per_lease = 5;
constexpr off_t largest_file = off_t{32} << 20U;  // an answer is two lines of messages, of at most 16 MB

[[noreturn]] void broken(const fs::path& file, std::string_view what, int number = errno) {
    throw SystemError(fmt::format("'{}': cannot be {}: {}", file.string(), what, std::strerror(number)));
}

files::Descriptor opened(const fs::path& file, int flags) {
    if (files::is_locked_file(file)) {
        errno = EBUSY;
        return {};
    }
    return files::Descriptor(::open(file.c_str(), flags | O_CLOEXEC, 0666));
}

/// Files of a spool are regular, and opening anything else must neither wait nor follow a link.
constexpr int to_read = O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_NOCTTY;

struct Contents {
    std::string text;
    std::string fault = {};  ///< why these are not the contents of a spool's file; empty: they are
};

/// Returns the contents; empty if there is no such file.
std::optional<Contents> contents_of_file(const fs::path& file) {
    const auto stream = opened(file, to_read);
    if (!stream.is_open()) {
        if (errno == ENOENT || errno == ESTALE) return std::nullopt;
        if (errno == ELOOP) return Contents{{}, "it is a link"};
        if (errno == EACCES || errno == EPERM || errno == ENXIO || errno == ENODEV)
            return Contents{{}, fmt::format("it cannot be read: {}", std::strerror(errno))};
        broken(file, "read");
    }
    struct stat status {};
    if (::fstat(stream.number(), &status) != 0) broken(file, "read");
    if (!S_ISREG(status.st_mode)) return Contents{{}, "it is no regular file"};
    if (status.st_size > largest_file) return Contents{{}, fmt::format("it has more than {} MB", largest_file >> 20U)};
    Contents contents;
    std::array<char, 65536> part{};
    while (true) {
        const auto length = ::read(stream.number(), part.data(), part.size());
        if (length < 0 && errno == EINTR) continue;
        if (length < 0 && errno == ESTALE) return std::nullopt;
        if (length < 0) broken(file, "read");
        if (length == 0) return contents;
        contents.text.append(part.data(), static_cast<std::size_t>(length));
        if (contents.text.size() > static_cast<std::size_t>(largest_file))
            return Contents{{}, "it grows while it is read"};
    }
}

void put_in_place(const fs::path& file, std::string_view text) {
    files::AsideFile aside(file);
    aside.write(text);
    aside.take_place();
    files::sync_folder(file.parent_path());
}

std::string asked_text(const Asked& asked) {
    const std::string body = fmt::format("{}{}\n{}\n{}", campaign_head, asked.folder.string(), asked.cases, asked.text);
    return body + "\n" + campaign::content_hash(body) + "\n";
}

std::optional<Asked> asked_of(std::string_view text) {
    constexpr std::size_t tail = 34;
    if (text.size() < campaign_head.size() + tail || !text.starts_with(campaign_head)) return std::nullopt;
    const auto body = text.substr(0, text.size() - tail);
    if (text.substr(body.size()) != "\n" + campaign::content_hash(body) + "\n") return std::nullopt;
    auto rest = body.substr(campaign_head.size());
    const auto folder_end = rest.find('\n');
    const auto cases_end = rest.find('\n', folder_end + 1);
    if (cases_end == std::string_view::npos) return std::nullopt;
    return Asked{fs::path(rest.substr(0, folder_end)),
                 std::string(rest.substr(folder_end + 1, cases_end - folder_end - 1)),
                 std::string(rest.substr(cases_end + 1))};
}

/// Returns the time of the last change, ns; empty if the file is gone. Opens the file, so that a network file system
/// asks its server.
std::optional<std::int64_t> modified(const fs::path& file) {
    const auto stream = opened(file, to_read);
    struct stat seen {};
    if (!stream.is_open() || ::fstat(stream.number(), &seen) != 0 || !S_ISREG(seen.st_mode)) return std::nullopt;
    return std::int64_t{seen.st_mtim.tv_sec} * 1'000'000'000 + seen.st_mtim.tv_nsec;
}

}  // namespace

std::optional<Entry> entry_of(const fs::path& file, const campaign::Attempt& named, const SceneInfo& scene) {
    const auto contents = contents_of_file(file);
    if (!contents) return std::nullopt;
    if (!contents->fault.empty()) return Damaged{contents->fault};
    auto entry = entry_in(contents->text);
    const auto* answer = std::get_if<Answer>(&entry);
    if (answer == nullptr) return entry;
    if (answer->result.attempt != named) return Damaged{"it answers another attempt than its name says"};
    if (const auto name = campaign::undeclared(answer->result.observations, scene.observables))
        return Damaged{fmt::format("it measured '{}', which its scene does not declare so", *name)};
    return entry;
}

Asked Spool::asked_in(const fs::path& folder) {
    const auto text = contents_of_file(folder / "campaign");
    if (!text)
        throw campaign::input_error("DIR", folder.string(),
                                    "is no spool: 'grainsweep work CONFIG --spool DIR' makes one");
    auto asked = asked_of(text->text);
    if (!asked || !text->fault.empty())
        throw SystemError(fmt::format("'{}': is damaged, or no spool of this program", (folder / "campaign").string()));
    return std::move(*asked);
}

Spool::Spool(fs::path folder, const Asked& asked, const SceneInfo& scene) : folder_(std::move(folder)), scene_(&scene) {
    std::error_code error;
    for (const char* part : {"tasks", "cases"}) {
        fs::create_directories(folder_ / part, error);
        if (error) broken(folder_ / part, "made", error.value());
    }
    const auto file = folder_ / "campaign";
    // Tasks that begin together write the same.
    if (!fs::exists(file)) put_in_place(file, asked_text(asked));
    if (const auto there = asked_in(folder_); there.cases != asked.cases)
        throw campaign::input_error("--spool", folder_.string(),
                                    "is a spool of other cases; take another folder for this campaign file");
}

fs::path Spool::file_of(const campaign::Attempt& attempt) const {
    return folder_ / "cases" / fmt::format("{}.{}", attempt.case_id, attempt.number);
}

bool Spool::claim(const campaign::Attempt& attempt, const std::string& task) const {
    const auto path = file_of(attempt);
    auto file = opened(path, O_WRONLY | O_CREAT | O_EXCL);
    if (!file.is_open() && errno == EEXIST) return false;
    if (!file.is_open()) broken(path, "made");
    if (!files::write_all(file.number(), text_of(Claim{task})) || !file.close()) broken(path, "written");
    return true;
}

std::optional<Entry> Spool::read(const campaign::Attempt& attempt) const {
    return entry_of(file_of(attempt), attempt, *scene_);
}

void Spool::answer(const Answer& answer) const {
    put_in_place(file_of(answer.result.attempt), spool::text_of(answer));
}

void Spool::release(const campaign::Attempt& attempt) const {
    ::unlink(file_of(attempt).c_str());
}

TaskFile::TaskFile(const Spool& spool, double lease) : spool_(spool), lease_(lease) {
    std::array<char, 65> host{};
    ::gethostname(host.data(), host.size() - 1);
    name_ = fmt::format("{}.{}.{:08x}", host.data(), ::getpid(), std::random_device{}());
    file_ = spool_.task(name_);
    touch();
}

TaskFile::~TaskFile() {
    ::unlink(file_.c_str());
}

void TaskFile::touch() {
    auto file = opened(file_, O_WRONLY | O_CREAT);
    if (!file.is_open() || ::futimens(file.number(), nullptr) != 0 || !file.close()) broken(file_, "written");
}

void TaskFile::keep_young(double now) {
    if (now - touched_ < lease_ / touches_per_lease) return;
    touched_ = now;
    touch();
}

TaskFile::State TaskFile::state_of(const std::string& task) {
    const auto other = modified(spool_.task(task));
    if (!other) return State::dead;  // it has ended, and left this behind
    const auto file = spool_.task(task);
    if (is_silent(file, *other)) return State::dead;
    return watched_.at(file).first != *other ? State::renewed : State::lives;
}

bool TaskFile::is_abandoned(const campaign::Attempt& attempt) {
    const auto file = spool_.file_of(attempt);
    const auto claimed = modified(file);
    return claimed && is_silent(file, *claimed);
}

bool TaskFile::is_silent(const fs::path& file, std::int64_t modified_at) {
    using Clock = std::chrono::steady_clock;
    const double now = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    auto& seen = watched_.try_emplace(file, Watched{modified_at, modified_at, now}).first->second;
    if (std::exchange(seen.last, modified_at) != modified_at) seen.changed = now;
    touch();
    const auto own = modified(file_);  // by the clock of the file system
    return now - seen.changed > lease_ || (own && static_cast<double>(*own - modified_at) * 1e-9 > lease_);
}

}  // namespace grainsweep::spool
