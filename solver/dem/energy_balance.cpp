#include "solver/dem/energy_balance.hpp"

#include "solver/dem/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grainsweep::dem {

std::optional<std::string> EnergyBalance::flaw(const EnergyCheck& now) {
    if (const std::int64_t number = now.steps / energy_window; number != number_) {
        lowest_[1] = number == number_ + 1 ? lowest_[0] : none;
        lowest_[0] = none;
        number_ = number;
    }
    active_ = std::max(active_, now.active);
    const double gain = now.balance - std::min(lowest_[0], lowest_[1]);
    std::optional<std::string> found;
    if (!(gain <= largest_sound_energy_gain * (active_ + std::abs(now.walls))) && gain > -none) {
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(),
                      "contacts created %.3g J of energy, %.3g times the largest motion so far; the fastest particle",
                      gain, gain / active_);
        found = text.data();
    }
    lowest_[0] = std::min(lowest_[0], now.balance);
    return found;
}

}  // namespace grainsweep::dem
