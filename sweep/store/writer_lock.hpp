// Lock for one writer per database: a lock of the operating system on the database file itself. It ends with its
// process in all cases and leaves no file behind. All names of a file (links, other paths) share it.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace grainsweep::store {

class WriterLock {
public:
    /// Takes the lock, making an empty file if there is none. Returns nothing if another process has the lock. Throws
    /// BrokenWorld if the file cannot be opened for writing or its file system has no locks.
    [[nodiscard]] static std::optional<WriterLock> take(const std::filesystem::path& database);

private:
    explicit WriterLock(files::Descriptor descriptor) : descriptor_(std::move(descriptor)) {}
    files::Descriptor descriptor_;
};

/// Returns the magic number of statfs(2) of the file's file system, also for a file that does not exist yet; 0:
/// unknown.
[[nodiscard]] long file_system_of(const std::filesystem::path& file);
/// Returns the name of a network or cluster file system; empty for others. Hosts do not share memory there, so
/// write-ahead logs would be damaged.
[[nodiscard]] std::string_view network_file_system(long magic);
/// Throws WrongQuestion, with an alternative, for a database on a network file system.
void refuse_network(const std::filesystem::path& database, long magic);

}  // namespace grainsweep::store
