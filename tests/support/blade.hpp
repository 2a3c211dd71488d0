// Blade that spreads powder, as a wall.
#pragma once

#include "solver/dem/walls/wall.hpp"

namespace grainsweep::tests {

/// Bar with x velocity `speed` and the vertical displacement amplitude sin(2 pi frequency t). A sphere touches only its
/// closest point.
struct Blade {
    double front = 0, thickness = 0, bottom = 0, top = 0;  ///< m, at t = 0
    double speed = 0;                                      ///< m/s
    double amplitude = 0, frequency = 0;                   ///< m, Hz
    double edge_radius = 0;                                ///< m

    operator dem::Wall() const {  // NOLINT: a blade is a wall
        dem::Wall wall(
            dem::Bar{.front = front, .thickness = thickness, .bottom = bottom, .top = top, .edge_radius = edge_radius});
        wall.motions = {dem::Translation{.velocity = {speed, 0, 0}},
                        dem::Vibration{.amplitude = {0, 0, amplitude}, .frequency = frequency}};
        return wall;
    }
};

}  // namespace grainsweep::tests
