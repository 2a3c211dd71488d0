// A worker of the pool: its process, what it may write, and what is said of it.
#pragma once

#include "sweep/workers/crew.hpp"
#include "sweep/workers/line_buffer.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/process.hpp"
#include "sweep/workers/worker_state.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace grainsweep::workers {

struct PoolWorker {
    static constexpr double beats_apart = 0.5;  ///< s, of those that are passed on

    PoolWorker(std::shared_ptr<Process> process, const Expected& expected, double now)
        : state(expected, now), child(std::move(process)) {}
    WorkerState state;
    std::shared_ptr<Process> child;
    LineBuffer lines{longest_line};
    double beat = -beats_apart;  ///< when a heartbeat was last passed on
    bool stop_sent = false, remarked = false;
    std::int64_t threads = 1;  ///< of its case, as it was last told

    [[nodiscard]] std::string name() const;
    /// What it had in hands, and the reason why it is gone with what it wrote last.
    [[nodiscard]] Lost account(double now, const std::string& reason) const;
    /// Which worker is waited for: once, at half of its time. `command` started it.
    [[nodiscard]] std::optional<std::string> overdue_remark(const TimeLimits& limits, double now,
                                                            const std::string& command);
};

}  // namespace grainsweep::workers
