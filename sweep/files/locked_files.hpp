// Files that SQLite has open in this process.
//
// POSIX locks belong to a process and a file: closing any descriptor of the file ends all locks of the process on it.
// Then another process takes itself for the last user of the database and removes its write-ahead log, with what was
// committed. So code other than SQLite never opens a file that is entered here: reading goes through whole_file() and
// regular_file(), which refuse it, or asks is_locked_file() first. A test of the architecture lists all who open files.
#pragma once

#include <filesystem>
#include <utility>

#include <sys/types.h>

namespace grainsweep::files {

/// Entry of a file while a connection has it open.
class LockedFile {
public:
    LockedFile() = default;
    /// Enters the file. Does nothing if there is no such file.
    explicit LockedFile(const std::filesystem::path& file);
    LockedFile(LockedFile&& other) noexcept : id_(std::exchange(other.id_, {})) {}
    LockedFile& operator=(LockedFile&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~LockedFile();

    using Id = std::pair<dev_t, ino_t>;  ///< file system and number of a file; zeros: none

private:
    Id id_{};
};

/// Returns whether a connection of this process has the file open, under any of its names.
[[nodiscard]] bool is_locked_file(const std::filesystem::path& file);

}  // namespace grainsweep::files
