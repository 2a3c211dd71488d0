// A disk under SQLite that fails on demand, and records every write and sync so that any loss of power
// can be played back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// While it lives every SQLite connection opened in this process goes through it. One at a time.
class FailingDisk {
public:
    FailingDisk();
    FailingDisk(const FailingDisk&) = delete;
    FailingDisk& operator=(const FailingDisk&) = delete;
    ~FailingDisk();

    /// killed: the process is killed in place of the call.
    enum class Fault { input_output, full, killed };
    enum class Calls {
        changes,  ///< write, sync, truncate, remove
        looks,    ///< open, read, lock, map shared memory, ask for a size or whether a file is there
    };
    /// The n-th call from now on fails (n = 1, 2, ...), once or from then on.
    void fail_at(std::int64_t n, Fault fault, bool from_then_on, Calls calls = Calls::changes);
    void work_again();
    [[nodiscard]] bool has_failed() const;

    struct Event {
        enum class Kind { write, truncate, sync, remove, acknowledge };
        Kind kind = Kind::write;
        std::string file;              ///< name without folder
        std::int64_t offset = 0;       ///< of a write; new size of a truncation; number of an acknowledgement
        std::vector<std::byte> bytes;  ///< of a write
    };
    /// Everything that happened, in order.
    [[nodiscard]] const std::vector<Event>& events() const;
    /// The test's own mark in the record: what was promised to be on disk from here on.
    void acknowledge(std::int64_t number);

    struct State;

private:
    std::unique_ptr<State> state_;
};

/// What of the writes not yet synced is on the disk after the power went.
enum class Unsynced { lost, kept, torn };

using Disk = std::map<std::string, std::vector<std::byte>>;  ///< file name -> contents
/// The files after the first `count` events. torn: of the unsynced writes a part, in sectors of 512 bytes, chosen
/// by `seed`.
[[nodiscard]] Disk after_power_loss(const std::vector<FailingDisk::Event>& events, std::size_t count, Unsynced unsynced,
                                    std::uint64_t seed);
void write_disk(const Disk& disk, const std::filesystem::path& folder);

}  // namespace grainsweep::tests
