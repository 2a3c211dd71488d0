// Pictures of the particles and walls of a DEM engine.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/geometry/vector.hpp"
#include "solver/scenes/values.hpp"

#include <string>

namespace grainsweep {

/// Returns positions, m, of all particles present, with id, mobile (1, or 0: frozen), diameter, deepest overlap, m,
/// largest contact force, N, coordination, velocity, m/s, angular velocity, rad/s, and the sum of contact forces, N.
[[nodiscard]] Snapshot picture_of(const dem::Engine& engine);

/// Returns a wall `time` after the walls were set. A plane becomes the polygon of its intersection with the box. A
/// blade reaches from its lower edge to the top of the box, across its whole width. Cylinders, cones, tubes and meshes
/// are complete. No triangles: the wall is outside.
[[nodiscard]] WallSurface surface_of(const dem::Wall& wall, std::string name, const geometry::Vec3& low,
                                     const geometry::Vec3& high, double time);

/// Adds the eight corners and twelve edges of the box; returns the index of the corner `low`. A corner lies at the high
/// end of axis a if bit a of its index minus the returned index is set.
std::int32_t add_box(const std::array<double, 3>& low, const std::array<double, 3>& high, WallSurface& surface);

}  // namespace grainsweep
