// One writer per database: a lock of the operating system on the database file itself. It goes with its holder,
// however the holder dies, and leaves no file behind. All names of a file (links, other paths) share it.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace grainsweep::store {

class WriterLock {
public:
    /// Takes the lock, making an empty file where there is none; nothing where another one holds it. Throws
    /// BrokenWorld where the file cannot be opened to write or its file system gives no locks.
    [[nodiscard]] static std::optional<WriterLock> take(const std::filesystem::path& database);

private:
    explicit WriterLock(files::Descriptor descriptor) : descriptor_(std::move(descriptor)) {}
    files::Descriptor descriptor_;
};

/// The magic number of statfs(2) of the file system on which the file lies, or would; 0: not known.
[[nodiscard]] long file_system_of(const std::filesystem::path& file);
/// Its name where that is of a network or cluster file system, whose shared memory between hosts does not exist and
/// whose write-ahead logs therefore tear; empty: it is none.
[[nodiscard]] std::string_view network_file_system(long magic);
/// Throws WrongQuestion, with what to do instead, for a database on a file system of that number.
void refuse_network(const std::filesystem::path& database, long magic);

}  // namespace grainsweep::store
