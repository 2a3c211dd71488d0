#include "solver/observables/outflow.hpp"

#include "solver/observables/layer.hpp"
#include "solver/observables/line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace grainsweep::observables {
namespace {

constexpr std::size_t blocks = 5;
constexpr double clear_of_ends = 3;  // D
constexpr double top_share = 0.95;

double volume(double radius) {
    return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

}  // namespace

Outflow outflow(const dem::State& state, std::span<const double> radius, double density, double time) {
    Outflow out{time, 0, 0, 0};
    std::size_t k = 0;  // of the state, in which ids ascend
    for (std::size_t id = 0; id < radius.size(); ++id) {
        const bool present = k < state.id.size() && static_cast<std::size_t>(state.id[k]) == id;
        if (present && state.position[k++][2] > 0) continue;
        out.mass += density * volume(radius[id]);
        out.diameters += 2 * radius[id];
        ++out.count;
    }
    return out;
}

OutflowRate rate_between(std::span<const Outflow> frames, double whole, double from, double to) {
    std::vector<std::array<double, 2>> points;
    std::vector<double> flux;
    const Outflow* first = nullptr;
    const Outflow* last = nullptr;
    for (const Outflow& frame : frames) {
        if (!(frame.mass >= from * whole && frame.mass <= to * whole)) continue;
        points.push_back({frame.time, frame.mass});
        if (last != nullptr) flux.push_back((frame.mass - last->mass) / (frame.time - last->time));
        if (first == nullptr) first = &frame;
        last = &frame;
    }
    OutflowRate result;
    if (points.size() < 3) return result;
    result.rate = fitted_line(points).slope;
    result.standard_error = block_standard_error(flux, blocks);
    if (last->count > first->count)
        result.mean_diameter = (last->diameters - first->diameters) / static_cast<double>(last->count - first->count);
    return result;
}

double solid_over_opening(const dem::State& state, double half_width, double height, bool slot) {
    double solid = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const auto& x = state.position[i];
        const double off = slot ? std::abs(x[0]) : std::hypot(x[0], x[1]);
        if (off < half_width && x[2] > 0 && x[2] < height) solid += volume(state.radius[i]);
    }
    return solid;
}

double settled_fraction(const dem::State& state, double bottom, double diameter, double section) {
    std::vector<double> heights;
    for (const auto& x : state.position) heights.push_back(x[2]);
    if (heights.empty()) return OutflowRate::unknown;
    const auto place = static_cast<std::ptrdiff_t>(top_share * static_cast<double>(heights.size() - 1));
    std::ranges::nth_element(heights, heights.begin() + place);
    const double low = bottom + clear_of_ends * diameter;
    const double high = heights[static_cast<std::size_t>(place)] - clear_of_ends * diameter;
    if (!(high > low)) return OutflowRate::unknown;
    double solid = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i)
        if (state.position[i][2] > low && state.position[i][2] < high) solid += volume(state.radius[i]);
    return solid / (section * (high - low));
}

}  // namespace grainsweep::observables
