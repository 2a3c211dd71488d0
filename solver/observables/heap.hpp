// Shape of a heap on a plate z = 0, about its mass centre (x, y). Frozen spheres belong to the plate. Lengths in m,
// angles in degrees. Definitions as in the reference ensembles of tests/reference/walls.
//
//     outline        highest z + r of the centres in each column D x D (0: none), mean of the columns of each ring of
//                    width D
//     angle          slope of a line through the rings with 0.2 h <= height <= 0.8 h, up to the first below 0.2 h.
//                    h: largest height of the inner three rings. Corresponds to the angle seen by eye
//     angle_moment   atan(2 z_c/<r>) of the spheres within the first ring lower than D/2. Exact for a cone of uniform
//                    density, z_c = H/4, <r> = R/2; it needs no bins and scatters less
#pragma once

#include "solver/dem/engine.hpp"

#include <limits>
#include <vector>

namespace grainsweep::observables {

struct HeapShape {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double angle = unknown, residual = unknown;  ///< degrees; root mean square distance in height from the line, m
    double angle_moment = unknown;               ///< degrees
    double height = unknown;                     ///< h, m
    double run_out = unknown;                    ///< radius that contains nine tenths of the spheres, m
    std::vector<double> outline;                 ///< m, ring by ring
};

/// Returns the shape of the mobile spheres within `reach` of their mass centre, D = `diameter`.
[[nodiscard]] HeapShape heap_shape(const dem::State& state, double diameter, double reach);

/// Returns the root mean square speed of the mobile spheres, m/s; 0: there are none.
[[nodiscard]] double rms_speed(const dem::State& state);

}  // namespace grainsweep::observables
