// Time in which this process ran: what it spent stopped (Ctrl-Z, a suspended machine) does not count.
#pragma once

#include <algorithm>
#include <chrono>

namespace grainsweep::workers {

/// Asked several times a second; the time between two calls counts as a quarter of a second at most: a process that did
/// not come to ask was stopped, or too busy to have noticed what it waits for.
class AwakeClock {
public:
    explicit AwakeClock(std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now())
        : asked_(start) {}

    /// Seconds since it was made.
    double now() { return at(Clock::now()); }
    /// The same at a given moment of a clock.
    double at(std::chrono::steady_clock::time_point moment) {
        seconds_ += std::min(std::chrono::duration<double>(moment - asked_).count(), longest_gap);
        asked_ = moment;
        return seconds_;
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double longest_gap = 0.25;
    Clock::time_point asked_;
    double seconds_ = 0;
};

}  // namespace grainsweep::workers
