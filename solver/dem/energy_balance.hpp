// Energy that contacts create, found by checks between steps.
//
//     balance    B = kinetic + stored + potential energy - work of walls and shaking: contacts store or dissipate
//     unsound    B - B_low > 0.5 (A + |W|)
//
// B_low is the lowest balance of the last energy_window steps, or up to twice as many. A is the largest energy in
// motion and in contacts at any check since the start: the motion of one moment vanishes at the top of a bounce. W is
// the work of the walls. An unstable integration gains its energy within tens of steps. Over a longer time sound steps
// gain, too: errors of many elastic bounces add up at random, and rolling springs that are not turned with their
// contact (laws/rolling.hpp) drive a slow spin, whatever the step.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace grainsweep::dem {

inline constexpr std::int64_t energy_window = 4096;  ///< steps

/// State at a check.
struct EnergyCheck {
    std::int64_t steps = 0;  ///< so far
    double balance = 0;      ///< B, J
    double active = 0;       ///< in motion and in contacts, J
    double walls = 0;        ///< work of the walls since they were set, J
};

class EnergyBalance {
public:
    /// Particles or walls changed: the next check is the first one.
    void restart() { lowest_ = {none, none}; }
    /// Returns what is wrong where contacts created more energy than errors of the time steps explain.
    [[nodiscard]] std::optional<std::string> flaw(const EnergyCheck& now);

private:
    static constexpr double none = std::numeric_limits<double>::infinity();

    std::array<double, 2> lowest_ = {none, none};  ///< balance of this window and of the one before
    double active_ = 0;                            ///< A
    std::int64_t number_ = 0;                      ///< of this window
};

}  // namespace grainsweep::dem
