// What has left a hopper, frame by frame, and the rate of it.
#pragma once

#include "solver/dem/engine.hpp"

#include <cstdint>
#include <limits>
#include <span>

namespace grainsweep::observables {

/// Sums over the spheres whose centres are not above z = 0, or gone.
struct Outflow {
    double time = 0;       ///< s
    double mass = 0;       ///< kg
    double diameters = 0;  ///< m, sum
    std::int64_t count = 0;
};

/// `radius` by id, of all spheres there were.
[[nodiscard]] Outflow outflow(const dem::State& state, std::span<const double> radius, double density, double time);

struct OutflowRate {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double rate = unknown;            ///< kg/s
    double standard_error = unknown;  ///< from the spread of blocks, kg/s
    double mean_diameter = unknown;   ///< of what left meanwhile, m
};

/// Least-squares slope of the mass over the frames between `from` and `to` of `whole`; unknown for fewer than three.
[[nodiscard]] OutflowRate rate_between(std::span<const Outflow> frames, double whole, double from, double to);

/// Solid volume of the centres within a distance of the axis z, or of the plane x = 0 for a slot, and 0 < z < height.
[[nodiscard]] double solid_over_opening(const dem::State& state, double half_width, double height, bool slot);

/// Solid fraction of a settled powder between z = bottom + 3 D and 3 D below the height that 95 % of the centres do not
/// reach, in a vessel of this cross-section; unknown where it is lower than that.
[[nodiscard]] double settled_fraction(const dem::State& state, double bottom, double diameter, double section);

}  // namespace grainsweep::observables
