// Closest point of a boundary to the centre of a sphere: distance, and direction of the normal force.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <limits>

namespace grainsweep::geometry {

struct Closest {
    double distance = 0;  ///< from the surface to the point, m; negative inside the solid
    Vec3 normal{};        ///< unit, from the surface to the point
};

/// Side of the particles, for a surface that closes around an axis.
enum class Side : std::int32_t { inside, outside };

/// Extent of a solid along one axis, m.
struct Extent {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool bounded() const { return std::isfinite(low) && std::isfinite(high); }
};

}  // namespace grainsweep::geometry
