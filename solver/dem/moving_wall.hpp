// Walls in motion: the shape, displacement and velocity of a wall at a time after the walls were set.
//
//     blade:  x = x_0 + v t,   z = z_0 + A sin(2 pi f t)
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/geometry/bar.hpp"
#include "solver/geometry/plane.hpp"

namespace grainsweep::dem {

[[nodiscard]] geometry::Plane shape_at(const Plane& plane, double time);
[[nodiscard]] geometry::Bar shape_at(const Blade& blade, double time);

/// Displacement since the walls were set, m.
[[nodiscard]] Vec3 displacement_at(const Wall& wall, double time);
[[nodiscard]] Vec3 velocity_at(const Wall& wall, double time);

/// Upper bound of the wall's speed at all times, m/s.
[[nodiscard]] double fastest(const Wall& wall);

}  // namespace grainsweep::dem
