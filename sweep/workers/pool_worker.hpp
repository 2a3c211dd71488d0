// Worker of the pool: its process, the state of its protocol, and messages about it.
#pragma once

#include "sweep/workers/line_buffer.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/process.hpp"
#include "sweep/workers/worker_pool.hpp"
#include "sweep/workers/worker_state.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace grainsweep::workers {

struct PoolWorker {
    static constexpr double beats_apart = 0.5;  ///< s; heartbeats that come faster are not passed on

    PoolWorker(std::shared_ptr<Process> process, const Expected& expected, double now)
        : state(expected, now), child(std::move(process)) {}
    WorkerState state;
    std::shared_ptr<Process> child;
    LineBuffer lines{longest_line};
    double beat = -beats_apart;  ///< when a heartbeat was last passed on
    bool stop_sent = false, remarked = false;
    std::int64_t threads = 1;  ///< threads of its case, as last sent

    [[nodiscard]] std::string name() const;
    /// Returns the attempts that the lost worker had, why it ended, and the end of its log.
    [[nodiscard]] Lost account(double now, const std::string& reason) const;
    /// Returns a message that the run waits for this worker: once, at half of its time limit. `command`: the command
    /// that started it.
    [[nodiscard]] std::optional<std::string> overdue_remark(const TimeLimits& limits, double now,
                                                            const std::string& command);
};

}  // namespace grainsweep::workers
