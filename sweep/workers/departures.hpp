// Processes that the pool has given up, until they have ended: each receives TERM, later KILL. Times are seconds of any
// clock that never goes back.
#pragma once

#include "sweep/workers/process.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace grainsweep::workers {

class Departures {
public:
    /// Kills a process at once. A process started by a launcher receives TERM first, so that the launcher ends its own
    /// children.
    void hurry(std::shared_ptr<Process> child, bool launched, double now);
    /// Lets a process end by itself. It receives TERM, then KILL, if it takes too long.
    void let_go(std::shared_ptr<Process> child, double now);
    void keep_time(double now);
    /// Returns how many of these processes still occupy a worker's place. A process that cannot be ended does not keep
    /// its place for ever.
    [[nodiscard]] std::size_t places_taken(double now) const;
    /// Ends these processes and all that are already ending, and waits for them. A launcher still has work after its
    /// worker has ended; srun, for example, returns its part of the machine. So it first gets time, then TERM, and KILL
    /// last. A process that cannot be killed (it waits for a dead file server) is left behind.
    void end_all(std::vector<std::shared_ptr<Process>> children);

private:
    struct One {
        std::shared_ptr<Process> child;
        double since = 0;
        double ask_at = 0, kill_at = 0;  // when it is sent TERM and KILL
        bool asked = false, killed = false;
    };
    static void escalate(One& one, double now);

    std::vector<One> leaving_;
};

}  // namespace grainsweep::workers
