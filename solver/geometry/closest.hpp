// The closest point of a boundary to the centre of a sphere: its distance, and the direction of its normal force.
#pragma once

#include "solver/geometry/vector.hpp"

namespace grainsweep::geometry {

struct Closest {
    double distance = 0;  ///< from the surface to the point, m; negative inside the solid
    Vec3 normal{};        ///< unit, from the surface to the point
};

}  // namespace grainsweep::geometry
