// What a DEM engine shows of its particles at this moment.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep {

/// Positions, m, of all particles present, with id, mobile (1, or 0: frozen), diameter, deepest overlap, m, largest
/// contact force, N, coordination, velocity, m/s, angular velocity, rad/s, and the sum of contact forces, N.
[[nodiscard]] Snapshot picture_of(const dem::Engine& engine);

}  // namespace grainsweep
