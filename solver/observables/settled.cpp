#include "solver/observables/settled.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace grainsweep::observables {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double clear_of_ends = 3;  // D
constexpr double top_share = 0.95;

double volume(double radius) {
    return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

}  // namespace

double settled_fraction(const dem::State& state, double bottom, double diameter, double section) {
    std::vector<double> heights;
    for (const auto& x : state.position) heights.push_back(x[2]);
    if (heights.empty()) return unknown;
    const auto place = static_cast<std::ptrdiff_t>(top_share * static_cast<double>(heights.size() - 1));
    std::ranges::nth_element(heights, heights.begin() + place);
    const double low = bottom + clear_of_ends * diameter;
    const double high = heights[static_cast<std::size_t>(place)] - clear_of_ends * diameter;
    if (!(high > low)) return unknown;
    double solid = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i)
        if (state.position[i][2] > low && state.position[i][2] < high) solid += volume(state.radius[i]);
    return solid / (section * (high - low));
}

}  // namespace grainsweep::observables
