#include "sweep/workers/program_folder.hpp"

#include "sweep/files/system_error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace grainsweep::workers {
namespace {

namespace fs = std::filesystem;
using files::Descriptor;

constexpr std::int64_t most_files_counted = 1'000'000;

[[noreturn]] void broken(const fs::path& what, int number) {
    throw SystemError(fmt::format("'{}': cannot be written: {}", what.string(), std::strerror(number)));
}

struct CloseDir {
    void operator()(DIR* folder) const { ::closedir(folder); }
};
using Entries = std::unique_ptr<DIR, CloseDir>;

/// Returns the entries of a folder within another, no link; empty if it cannot be opened.
Entries entries_of(int parent, const char* name) {
    Descriptor at(::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    Entries entries(at.is_open() ? ::fdopendir(at.number()) : nullptr);
    if (entries) (void)at.release();
    return entries;
}

/// The next name but "." and "..".
const char* next_name(const Entries& entries) {
    while (const auto* entry = ::readdir(entries.get())) {
        const std::string_view name = entry->d_name;
        if (name != "." && name != "..") return entry->d_name;
    }
    return nullptr;
}

bool is_folder(int parent, const char* name) {
    struct stat status {};
    return ::fstatat(parent, name, &status, AT_SYMLINK_NOFOLLOW) == 0 && S_ISDIR(status.st_mode);
}

/// Removes a folder of any depth with two open files: folders within folders are lifted to the top first. Its owner may
/// have taken away the right to.
void take_down(const fs::path& folder) {
    ::chmod(folder.c_str(), S_IRWXU);
    std::int64_t lifted = 0;
    for (bool again = true; std::exchange(again, false);) {
        const auto top = entries_of(AT_FDCWD, folder.c_str());
        if (!top) break;
        const int at = ::dirfd(top.get());
        while (const char* name = next_name(top)) {
            if (!is_folder(at, name)) {
                again = ::unlinkat(at, name, 0) == 0 || again;
                continue;
            }
            ::fchmodat(at, name, S_IRWXU, 0);
            if (const auto inner = entries_of(at, name)) {
                const int within = ::dirfd(inner.get());
                while (const char* part = next_name(inner)) {
                    if (!is_folder(within, part)) {
                        ::unlinkat(within, part, 0);
                        continue;
                    }
                    ::fchmodat(within, part, S_IRWXU, 0);
                    ::renameat(within, part, at, fmt::format(".lifted.{}.{}", ::getpid(), lifted++).c_str());
                }
            }
            again = ::unlinkat(at, name, AT_REMOVEDIR) == 0 || again;
        }
    }
    ::rmdir(folder.c_str());
}

void clear_away(const fs::path& folder) {
    std::error_code error;
    fs::remove_all(folder, error);
    if (error) take_down(folder);
}

/// Adds the size of a folder's contents, up to `most` bytes. Folders deeper than a case may have are ignored.
void measure(const Entries& entries, int depth, std::int64_t most, ProgramFolder::Size& total) {
    constexpr int deepest = 100;
    if (!entries) return;
    const int at = ::dirfd(entries.get());
    while (const char* name = next_name(entries)) {
        struct stat status {};
        if (::fstatat(at, name, &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
        total.bytes += 512 * static_cast<std::int64_t>(status.st_blocks);
        ++total.files;
        if (S_ISDIR(status.st_mode)) {
            if (depth == deepest) total.too_deep = true;
            if (!total.too_deep) measure(entries_of(at, name), depth + 1, most, total);
        }
        if (total.too_deep || total.files >= most_files_counted || total.bytes >= most) return;
    }
}

}  // namespace

ProgramFolder::ProgramFolder(fs::path path) : path_(std::move(path)) {
    if (::mkdir(path_.c_str(), 0777) != 0) {
        if (errno == EEXIST) clear_away(path_);
        std::error_code error;
        fs::create_directories(path_.parent_path(), error);
        if (::mkdir(path_.c_str(), 0777) != 0) broken(path_, errno);
    }
    folder_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder_.is_open()) broken(path_, errno);
}

ProgramFolder::ProgramFolder(Kept, fs::path path)
    : path_(std::move(path)),
      folder_(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)),
      kept_(true) {}

ProgramFolder::~ProgramFolder() {
    (void)folder_.close();
    if (!kept_) clear_away(path_);
}

/// The folder that the last part of a name lies in, without following a link.
Descriptor ProgramFolder::parent_of(const std::string& name, std::string& leaf) const {
    Descriptor at(::fcntl(folder_.number(), F_DUPFD_CLOEXEC, 0));
    std::string_view rest = name;
    for (auto slash = rest.find('/'); slash != std::string_view::npos && at.is_open(); slash = rest.find('/')) {
        const std::string part(rest.substr(0, slash));
        Descriptor next(::openat(at.number(), part.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
        const int number = errno;
        at = std::move(next);
        (void)next.close();
        errno = number;
        rest.remove_prefix(slash + 1);
    }
    leaf = rest;
    return at;
}

Descriptor ProgramFolder::create(const std::string& name) const {
    std::string leaf;
    if (name.find('/') != std::string::npos) {
        std::error_code error;
        // The program has not begun: nothing is a link yet.
        fs::create_directories((path_ / name).parent_path(), error);
    }
    const auto parent = parent_of(name, leaf);
    Descriptor file(::openat(parent.number(), leaf.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!file.is_open()) broken(path_ / name, errno);
    return file;
}

void ProgramFolder::write(const std::string& name, std::string_view contents, bool executable) const {
    const auto file = create(name);
    if (!files::write_all(file.number(), contents)) broken(path_ / name, errno);
    if (executable) ::fchmod(file.number(), 0777);
}

void ProgramFolder::copy(const std::string& name, const fs::path& from, bool executable) const {
    const Descriptor source(::open(from.c_str(), O_RDONLY | O_CLOEXEC));
    const auto unreadable = [&] {
        return SystemError(fmt::format("'{}': cannot be read: {}", from.string(), std::strerror(errno)));
    };
    if (!source.is_open()) throw unreadable();
    const auto file = create(name);
    if (executable) ::fchmod(file.number(), 0777);
    if (::ioctl(file.number(), FICLONE, source.number()) == 0) return;  // where the disk can share the blocks
    std::array<char, 65536> piece{};
    while (true) {
        const auto length = ::read(source.number(), piece.data(), piece.size());
        if (length < 0 && errno == EINTR) continue;
        if (length < 0) throw unreadable();
        if (length == 0) return;
        if (!files::write_all(file.number(), {piece.data(), static_cast<std::size_t>(length)}))
            broken(path_ / name, errno);
    }
}

Descriptor ProgramFolder::open(const std::string& name, std::string& why) const {
    std::string leaf;
    const auto parent = parent_of(name, leaf);
    const auto missing = [&](int number) {
        why = number == ELOOP || number == ENOTDIR ? "is a link, or lies behind one, and those are not followed"
              : number == ENOENT                   ? "was not written"
                                                   : fmt::format("cannot be read: {}", std::strerror(number));
        return Descriptor();
    };
    if (!parent.is_open()) return missing(errno);
    Descriptor file(::openat(parent.number(), leaf.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!file.is_open()) return missing(errno);
    struct stat status {};
    if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) {
        why = "is no regular file";
        return {};
    }
    return file;
}

std::optional<std::string> ProgramFolder::read(const std::string& name, std::size_t most_bytes,
                                               std::string& why) const {
    const auto file = open(name, why);
    if (!file.is_open()) return std::nullopt;
    struct stat status {};
    if (::fstat(file.number(), &status) != 0 || static_cast<std::size_t>(status.st_size) > most_bytes) {
        why = fmt::format("has {} MB, and at most {} are read", status.st_size / 1'000'000, most_bytes / 1'000'000);
        return std::nullopt;
    }
    std::string text(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t have = 0;
    while (have < text.size()) {
        const auto length = ::read(file.number(), text.data() + have, text.size() - have);
        if (length < 0 && errno == EINTR) continue;
        if (length <= 0) break;
        have += static_cast<std::size_t>(length);
    }
    text.resize(have);
    return text;
}

bool ProgramFolder::has(const std::string& name) const {
    struct stat status {};
    return ::fstatat(folder_.number(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

std::string ProgramFolder::end_of(const std::string& name, std::size_t bytes) const {
    std::string why;
    const auto file = open(name, why);
    if (!file.is_open()) return {};
    const off_t size = ::lseek(file.number(), 0, SEEK_END);
    const off_t from = std::max<off_t>(0, size - static_cast<off_t>(bytes));
    std::string text(static_cast<std::size_t>(size - from), '\0');
    const auto got = ::pread(file.number(), text.data(), text.size(), from);
    text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    if (from > 0) text.erase(0, std::min(text.find('\n'), text.size() - 1) + 1);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    return text;
}

ProgramFolder::Size ProgramFolder::size(std::int64_t most) const {
    Size total;
    measure(entries_of(folder_.number(), "."), 1, most, total);
    return total;
}

void ProgramFolder::keep_as(const std::string& name) {
    const auto to = path_.parent_path() / name;
    clear_away(to);
    std::error_code error;
    fs::rename(path_, to, error);
    if (!error) kept_ = true;
}

void sweep_program_folders(const fs::path& cases) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(cases, ignored))
        if (entry.path().filename().string().ends_with(running_suffix)) clear_away(entry.path());
}

}  // namespace grainsweep::workers
