// Infinite plane: distance = (x - point) . normal; the solid lies on the other side.
#pragma once

#include "solver/geometry/closest.hpp"

namespace grainsweep::geometry {

struct Plane {
    Vec3 point{};
    Vec3 normal{0, 0, 1};  ///< unit

    [[nodiscard]] Closest closest(const Vec3& x) const { return {dot(x - point, normal), normal}; }
};

}  // namespace grainsweep::geometry
