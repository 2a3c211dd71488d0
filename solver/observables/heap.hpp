// The shape of a heap on a plate z = 0: pure functions of a state. Frozen spheres belong to the plate. About the mass
// centre (x, y); lengths in m, angles in degrees. Definitions as in the reference ensembles of tests/reference/walls.
//
//     outline        highest z + r of the centres in each column D x D (0: none), mean over the columns of each ring of
//                    width D
//     angle          of the line through the rings with 0.2 h <= height <= 0.8 h up to the first below 0.2 h, h the
//                    largest height of the inner three: what the eye sees
//     angle_moment   atan(2 z_c/<r>) of the spheres within the first ring lower than D/2: exact for a cone of even
//                    density, z_c = H/4, <r> = R/2; no bins, and less scatter
#pragma once

#include "solver/dem/engine.hpp"

#include <limits>
#include <vector>

namespace grainsweep::observables {

struct HeapShape {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double angle = unknown, residual = unknown;  ///< degrees; root mean square height off the line, m
    double angle_moment = unknown;               ///< degrees
    double height = unknown;                     ///< h, m
    double run_out = unknown;                    ///< distance within which nine tenths of the spheres lie, m
    std::vector<double> outline;                 ///< m, ring by ring
};

/// Of the mobile spheres within `reach` of their mass centre, D = `diameter`.
[[nodiscard]] HeapShape heap_shape(const dem::State& state, double diameter, double reach);

/// Root mean square speed of the mobile spheres, m/s; 0: there are none.
[[nodiscard]] double rms_speed(const dem::State& state);

}  // namespace grainsweep::observables
