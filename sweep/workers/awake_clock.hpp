// Clock of the time in which this process ran. Time in which it was stopped (Ctrl-Z, a suspended machine) does not
// count.
#pragma once

#include <algorithm>
#include <chrono>

namespace grainsweep::workers {

/// Clock that is read several times a second. The time between two readings counts as a quarter of a second at most.
/// After a longer pause the process was stopped, or too busy to notice the event that it waits for.
class AwakeClock {
public:
    explicit AwakeClock(std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now())
        : asked_(start) {}

    /// Returns the seconds since the clock was made.
    double now() { return at(Clock::now()); }
    /// Returns the same at a given moment of the steady clock.
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
