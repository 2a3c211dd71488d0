// The closest point of a boundary, as a sphere sees it: how far, and in which direction it pushes.
#pragma once

#include "solver/geometry/vector.hpp"

namespace grainsweep::geometry {

struct Closest {
    double distance = 0;  ///< from the surface to the point, m; negative inside the solid
    Vec3 normal{};        ///< unit, from the surface to the point
};

}  // namespace grainsweep::geometry
