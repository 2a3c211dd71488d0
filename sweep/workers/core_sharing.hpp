// How many threads compute each case of a pool. One while there are enough cases for all cores; where fewer are left,
// the cores left over go to those that run, and come back when others begin. No bit of an answer depends on it.
#pragma once

#include "sweep/workers/crew.hpp"
#include "sweep/workers/pool_worker.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace grainsweep::workers {

/// Threads of each of the cases that run on a node of so many cores, while `waiting` others could begin there: equal
/// shares of what these leave, and where that does not come out even, one more for those with most seconds left.
[[nodiscard]] std::vector<std::int64_t> shared_cores(std::size_t cores, std::size_t waiting,
                                                     std::span<const double> seconds_left);

/// Tells workers how many threads they may use.
class CoreSharing {
public:
    /// `threads` of every case; none: shared as above. `cores` of every node, one for each worker.
    CoreSharing(std::optional<std::int64_t> threads, std::size_t cores) : threads_(threads), cores_(cores) {}

    /// A case is about to be written to this worker.
    void begin(PoolWorker& worker) const;
    /// So many cases wait that no worker could take.
    void share(std::span<const std::shared_ptr<PoolWorker>> workers, std::size_t waiting,
               const Crew::SecondsLeft& left);

private:
    /// The workers that have cases, and the threads these have: as long as they are the same nothing is told anew.
    using Shares = std::vector<std::pair<const PoolWorker*, std::int64_t>>;

    std::optional<std::int64_t> threads_;
    std::size_t cores_;
    bool shared_ = false;  ///< some case has more than one
    std::size_t waiting_ = 0;
    Shares shares_;
};

}  // namespace grainsweep::workers
