// One writer per database: a lock of the operating system on the database file itself. It goes with its holder,
// however the holder dies, and leaves no file behind. All names of a file (links, other paths) share it.
#pragma once

#include <filesystem>
#include <optional>

namespace grainsweep::store {

class WriterLock {
public:
    /// Takes the lock, making an empty file where there is none; nothing where another one holds it. Throws
    /// BrokenWorld where the file cannot be opened to write or its file system gives no locks.
    [[nodiscard]] static std::optional<WriterLock> take(const std::filesystem::path& database);
    WriterLock(WriterLock&& other) noexcept;
    WriterLock& operator=(WriterLock&&) = delete;
    ~WriterLock();

private:
    explicit WriterLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;
};

/// True where the folder of the file lies on a network or cluster file system, whose shared memory between
/// hosts does not exist and whose write-ahead logs therefore tear.
[[nodiscard]] bool on_network(const std::filesystem::path& file);
/// The same by the magic number of statfs(2).
[[nodiscard]] bool is_network_file_system(long magic);

}  // namespace grainsweep::store
