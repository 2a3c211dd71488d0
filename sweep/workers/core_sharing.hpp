// Number of threads of each case of a pool. Each case has one thread while there are enough cases for all cores. If
// fewer cases are left, idle cores go to the running cases, and come back when other cases begin. Answers have the same
// bits for any number of threads.
#pragma once

#include "sweep/workers/pool_worker.hpp"
#include "sweep/workers/worker_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace grainsweep::workers {

/// Returns the threads of each case that runs on a node with `cores` cores, while `waiting` other cases could begin
/// there. One core is kept for each waiting case. The running cases share the rest equally; remaining cores go to the
/// cases with most seconds left.
[[nodiscard]] std::vector<std::int64_t> shared_cores(std::size_t cores, std::size_t waiting,
                                                     std::span<const double> seconds_left);

/// Sender of the numbers of threads to the workers.
class CoreSharing {
public:
    /// `threads`: of every case; empty: shared as above. `cores`: of every node, one for each worker.
    CoreSharing(std::optional<std::int64_t> threads, std::size_t cores) : threads_(threads), cores_(cores) {}

    /// Sets the threads of a worker that is about to receive a case.
    void begin(PoolWorker& worker) const;
    /// Shares the cores while `waiting` cases have no worker.
    void share(std::span<const std::shared_ptr<PoolWorker>> workers, std::size_t waiting,
               const WorkerPool::SecondsLeft& left);

private:
    /// Workers that have cases, and their threads. Resent only when this list changes.
    using Shares = std::vector<std::pair<const PoolWorker*, std::int64_t>>;

    std::optional<std::int64_t> threads_;
    std::size_t cores_;
    bool shared_ = false;  ///< some case has more than one thread
    std::size_t waiting_ = 0;
    Shares shares_;
};

}  // namespace grainsweep::workers
