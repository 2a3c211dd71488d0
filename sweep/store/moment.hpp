// The only clock of the store.
#pragma once

#include <chrono>
#include <string>

namespace grainsweep::store {

/// Returns the present time in UTC, ISO 8601 with milliseconds: 2026-01-31T12:00:00.000Z.
[[nodiscard]] std::string utc_now();

/// Clock of one run, based on the system clock at its start: differences are elapsed times, even if the system clock is
/// changed during the run.
class RunClock {
public:
    [[nodiscard]] std::string start() const;
    [[nodiscard]] std::string now() const;

private:
    std::chrono::system_clock::time_point date_ = std::chrono::system_clock::now();
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace grainsweep::store
