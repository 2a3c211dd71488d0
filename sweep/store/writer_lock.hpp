// One writer per database: an advisory lock of the operating system on a file beside it. It goes with its
// holder, however the holder dies, so no lock is ever stale and none is removed by hand.
#pragma once

#include <filesystem>

namespace grainsweep::store {

class WriterLock {
public:
    /// Throws BrokenWorld naming the holder (process, host, since when) where another one writes.
    explicit WriterLock(const std::filesystem::path& database);
    WriterLock(WriterLock&& other) noexcept;
    WriterLock& operator=(WriterLock&&) = delete;
    ~WriterLock();

private:
    int descriptor_ = -1;
};

/// True where the folder of the file lies on a network or cluster file system, whose shared memory between
/// hosts does not exist and whose write-ahead logs therefore tear.
[[nodiscard]] bool on_network(const std::filesystem::path& file);
/// The same by the magic number of statfs(2).
[[nodiscard]] bool is_network_file_system(long magic);

}  // namespace grainsweep::store
