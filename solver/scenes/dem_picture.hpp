// What a DEM engine shows of its particles at this moment.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/geometry/vector.hpp"
#include "solver/scenes/values.hpp"

#include <string>

namespace grainsweep {

/// Positions, m, of all particles present, with id, mobile (1, or 0: frozen), diameter, deepest overlap, m, largest
/// contact force, N, coordination, velocity, m/s, angular velocity, rad/s, and the sum of contact forces, N.
[[nodiscard]] Snapshot picture_of(const dem::Engine& engine);

/// Returns a wall `time` after the walls were set. A plane is the polygon that it cuts out of the box. A blade reaches
/// from its lower edge to the top of the box, across its whole width. Cylinders, cones, tubes and meshes are whole. No
/// triangles: it is outside.
[[nodiscard]] WallSurface surface_of(const dem::Wall& wall, std::string name, const geometry::Vec3& low,
                                     const geometry::Vec3& high, double time);

}  // namespace grainsweep
