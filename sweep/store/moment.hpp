// When: the archive's only clock.
#pragma once

#include <chrono>
#include <string>

namespace grainsweep::store {

/// The present in UTC, ISO 8601 with milliseconds: 2026-01-31T12:00:00.000Z.
[[nodiscard]] std::string utc_now();

/// Moments of one run by the clock as it stood when the run began: their differences are times that passed, also where
/// the clock of the system is set meanwhile.
class RunClock {
public:
    [[nodiscard]] std::string start() const;
    [[nodiscard]] std::string now() const;

private:
    std::chrono::system_clock::time_point date_ = std::chrono::system_clock::now();
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace grainsweep::store
