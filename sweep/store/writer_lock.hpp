// Lock for one writer per database: a lock of the operating system on the database file itself. It ends with its
// process in all cases and leaves no file behind. All names of a file (links, other paths) share it.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace grainsweep::store {

class WriterLock {
public:
    /// Takes the lock with the descriptor of a connection (Connection::descriptor), which must outlive this object.
    /// Returns nothing if another connection has the lock. Throws SystemError if the file system has no locks.
    [[nodiscard]] static std::optional<WriterLock> take(int descriptor, const std::filesystem::path& database);
    WriterLock(WriterLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    WriterLock& operator=(WriterLock&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    ~WriterLock();

    /// Returns whether another connection, of any process, has the lock of the file of this descriptor.
    [[nodiscard]] static bool is_taken(int descriptor);

private:
    explicit WriterLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;
};

/// Returns the magic number of statfs(2) of the file's file system, also for a file that does not exist yet; 0:
/// unknown.
[[nodiscard]] long file_system_of(const std::filesystem::path& file);
/// Returns the name of a network or cluster file system; empty for others. Hosts do not share memory there, so
/// write-ahead logs would be damaged.
[[nodiscard]] std::string_view network_file_system(long magic);
/// Throws InputError, with an alternative, for a database on a network file system.
void refuse_network(const std::filesystem::path& database, long magic);

}  // namespace grainsweep::store
