#include "sweep/live/jobs.hpp"

#include "sweep/files/system_error.hpp"
#include "sweep/workers/process_start.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace grainsweep::live {
namespace {

/// A file in memory that ends with its descriptors.
files::Descriptor file_in_memory() {
    return files::Descriptor(::memfd_create("grainsweep", MFD_CLOEXEC));
}

std::string all_of(const files::Descriptor& file) {
    struct stat about {};
    if (::fstat(file.number(), &about) != 0) return {};
    std::string text(static_cast<std::size_t>(about.st_size), '\0');
    const auto count = ::pread(file.number(), text.data(), text.size(), 0);
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return text;
}

}  // namespace

void Jobs::end() {
    for (const auto& [number, job] : jobs_) {
        if (job.code) continue;
        ::kill(-job.process, SIGKILL);
        ::waitpid(job.process, nullptr, 0);
    }
    jobs_.clear();
}

bool Jobs::Job::goes_on() {
    int status = 0;
    if (!code && ::waitpid(process, &status, WNOHANG) != 0)
        code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + workers::ending_signal(status);
    return !code;
}

std::optional<std::int64_t> Jobs::start(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                                        const Bounds& bounds) {
    const auto running = std::ranges::count_if(jobs_, [](auto& one) { return one.second.goes_on(); });
    if (static_cast<std::size_t>(running) >= bounds.most_at_once) return std::nullopt;
    if (jobs_.size() >= most_kept)
        jobs_.erase(std::ranges::find_if(jobs_, [](const auto& one) { return one.second.code.has_value(); }));
    workers::ProcessStart start;
    if (const auto nice = workers::find_program("nice"); !nice.empty()) start.argv = {nice, "-n", "10"};
    start.argv.push_back(std::filesystem::read_symlink("/proc/self/exe").string());
    start.argv.insert(start.argv.end(), arguments.begin(), arguments.end());
    Job job{0, file_in_memory(), file_in_memory()};
    const files::Descriptor inside(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!job.out.is_open() || !job.err.is_open() || !inside.is_open()) return std::nullopt;
    start.streams = {-1, job.out.number(), job.err.number()};
    start.folder = inside.number();
    start.file = bounds.most_bytes;
    start.stranger = true;
    std::error_code error;
    job.process = workers::start_process(start, error);
    if (job.process < 0) return std::nullopt;
    jobs_.emplace(++last_, std::move(job));
    return last_;
}

bool Jobs::is_running(std::int64_t number) {
    const auto found = jobs_.find(number);
    return found != jobs_.end() && found->second.goes_on();
}

Jobs::State Jobs::look_at(std::int64_t number) {
    const auto found = jobs_.find(number);
    if (found == jobs_.end()) return {};
    auto& job = found->second;
    if (job.goes_on()) return {.known = true, .ended = {}};
    State state{true, Ended{*job.code, all_of(job.out), all_of(job.err)}};
    jobs_.erase(found);
    return state;
}

PrivateFolder::PrivateFolder() {
    std::error_code error;
    auto name = (std::filesystem::temp_directory_path(error) / "grainsweep-XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr)
        throw SystemError(
            fmt::format("'{}': no folder can be made there: {}", name, error ? error.message() : std::strerror(errno)));
    path_ = name;
}

void PrivateFolder::remove() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

bool Runner::start(const std::vector<std::string>& arguments, const std::filesystem::path& database) {
    auto log_file = database;
    log_file.replace_extension(".run.log");
    ::unlink(log_file.c_str());
    const files::Descriptor log(::open(log_file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
    const files::Descriptor inside(::open(database.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!log.is_open() || !inside.is_open()) return false;
    workers::ProcessStart start;
    start.argv = {std::filesystem::read_symlink("/proc/self/exe").string()};
    start.argv.insert(start.argv.end(), arguments.begin(), arguments.end());
    start.streams = {-1, log.number(), log.number()};
    start.folder = inside.number();
    std::error_code error;
    const pid_t process = workers::start_process(start, error);
    if (process >= 0) process_ = process;
    return process >= 0;
}

bool Runner::running() {
    if (process_ && ::waitpid(*process_, nullptr, WNOHANG) != 0) process_.reset();
    return process_.has_value();
}

}  // namespace grainsweep::live
