// Processes that no longer count, until they are gone: each is asked to end, then killed. Seconds are on any clock that
// only grows.
#pragma once

#include "sweep/workers/process.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace grainsweep::workers {

class Departures {
public:
    /// To be asked at once, or, where it was not launched by another program, killed at once. A launcher is asked
    /// first, so that it ends what it launched.
    void hurry(std::shared_ptr<Process> child, bool launched, double now);
    /// To end by itself; asked and killed where it takes its time.
    void let_go(std::shared_ptr<Process> child, double now);
    void keep_time(double now);
    /// Processes that are ending still use the machine, but one that cannot be ended must not keep its place.
    [[nodiscard]] std::size_t places_taken(double now) const;
    /// Ends all of these and those on their way out, and waits for it. A launcher has things to do after its worker has
    /// ended (srun gives its part of the machine back), so all are waited for, asked by a signal, and killed last. What
    /// cannot even be killed (it waits for a dead file server) is left behind.
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
