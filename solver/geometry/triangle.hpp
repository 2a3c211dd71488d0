// Triangle: its nearest point to another point, and the feature (face, side or corner) on which this point lies.
//
// If the foot of a point on the plane lies in the triangle, the nearest point is this foot, also for needles and
// slivers. Otherwise the nearest point is on one of the sides, for any angles.
#pragma once

#include "solver/geometry/vector.hpp"

#include <algorithm>
#include <cstdint>

namespace grainsweep::geometry {

enum class Feature : std::uint8_t { face, edge, vertex };

struct Nearest {
    Vec3 point{};
    double distance = 0;  ///< m, not negative
    Feature feature = Feature::face;
    std::uint8_t number = 0;  ///< number of a side (from corner 0 to 1, 1 to 2, 0 to 2) or of a corner
};

/// Triangle whose corners ascend in x, y, z. So two triangles compute the same bits for a point on their common side,
/// and no result depends on the order of corners in a file.
struct Triangle {
    std::array<Vec3, 3> corner{};
    Vec3 normal{};  ///< unit; either side of the triangle is a wall

    /// Returns the triangle of corners that are different and not on one line.
    [[nodiscard]] static Triangle of(std::array<Vec3, 3> corners);

    /// Returns the height of x above the plane on the side of the normal, m.
    [[nodiscard]] double height(const Vec3& x) const { return dot(normal, x - corner[0]); }

    /// Returns whether the foot of x on the plane lies in the triangle, including its sides.
    [[nodiscard]] bool below(const Vec3& x) const {
        const auto side = [&](std::size_t a, std::size_t b) {
            return dot(cross(corner[b] - corner[a], x - corner[a]), normal);
        };
        return side(0, 1) >= 0 && side(1, 2) >= 0 && side(2, 0) >= 0;
    }

    [[nodiscard]] Nearest nearest(const Vec3& x) const;
};

}  // namespace grainsweep::geometry
