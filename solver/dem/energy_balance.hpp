// Checks of the energy balance, which find energy created by contacts.
//
//     balance    B = kinetic + stored + potential energy - work of walls and shaking; physical contacts never raise it
//     unsound    B - B_low > 15 (A + |W|)
//
// B_low is the lowest balance of this window of energy_window steps and of the previous one; checks that are further
// apart have a window each. A is the largest energy in motion and in contacts before B_low was reached (not the present
// one, which vanishes at the top of a bounce). W is the work of the walls. An unstable integration multiplies its
// energy within tens of steps. Sound steps create energy, too, but slowly: errors of many elastic bounces add up at
// random, and strong cohesion at a restitution of 0.1 gains 0.4 A. Rolling springs that do not rotate with their
// contact (laws/rolling.hpp) spin small clusters up at any time step, by up to 7 A within a window.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace grainsweep::dem {

inline constexpr std::int64_t energy_window = 256;  ///< steps

/// State at a check.
struct EnergyCheck {
    std::int64_t steps = 0;  ///< so far
    double balance = 0;      ///< B, J
    double active = 0;       ///< energy in motion and in contacts, J
    double walls = 0;        ///< work of the walls since they were set, J
};

class EnergyBalance {
public:
    /// Restarts the balance after particles or walls have changed.
    void restart() { window_ = before_ = {}; }
    /// Returns the fault if contacts created more energy than time-stepping errors explain.
    [[nodiscard]] std::optional<std::string> flaw(const EnergyCheck& now);

private:
    struct Lowest {
        double balance = std::numeric_limits<double>::infinity();
        double active = 0;  ///< largest until then, J
    };

    Lowest window_, before_;
    double active_ = 0;        ///< largest so far, J
    std::int64_t number_ = 0;  ///< number of the window
};

}  // namespace grainsweep::dem
