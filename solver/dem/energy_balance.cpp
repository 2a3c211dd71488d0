#include "solver/dem/energy_balance.hpp"

#include "solver/dem/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace grainsweep::dem {

std::optional<std::string> EnergyBalance::flaw(const EnergyCheck& now) {
    if (const std::int64_t number = now.steps / energy_window; number != number_) {
        before_ = window_;
        window_ = {};
        number_ = number;
    }
    active_ = std::max(active_, now.active);
    const Lowest& low = window_.balance < before_.balance ? window_ : before_;
    const double gain = now.balance - low.balance;
    std::optional<std::string> found;
    if (gain > largest_sound_energy_gain * (low.active + std::abs(now.walls))) {
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(),
                      "contacts created %.3g J of energy, %.3g times the largest motion before; the fastest particle",
                      gain, gain / low.active);
        found = text.data();
    }
    if (now.balance < window_.balance) window_ = {now.balance, active_};
    return found;
}

}  // namespace grainsweep::dem
