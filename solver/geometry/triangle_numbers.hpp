// Triangle for one position or vectors of positions: height above its plane, and distance inside its sides.
//
// The distance is |height| if inside >= 0. Otherwise it is at least sqrt(height^2 + inside^2), because the foot lies
// beyond a side by -inside.
#pragma once

#include "solver/geometry/number.hpp"
#include "solver/geometry/triangle.hpp"

namespace grainsweep::geometry {

/// Numbers in units of their user, relative to the origin of the body.
struct TriangleNumbers {
    double normal[3], offset;
    struct {
        double inward[3], offset;  ///< unit vector in the plane, perpendicular to the side
    } side[3];
};

template <class R>
struct NearPiece {
    R height, inside;  ///< along the normal; distance from the nearest side line, negative beyond it
};

/// Returns height and distance inside. `numbers`: the members of TriangleNumbers in order.
template <class R>
[[gnu::always_inline]] inline NearPiece<R> near_triangle(const R* numbers, R x, R y, R z) {
    using namespace number;
    const auto along = [&](const R* n) __attribute__((always_inline)) {
        return fma(n[0], x, fma(n[1], y, n[2] * z)) - n[3];
    };
    return {along(numbers), min(along(numbers + 4), min(along(numbers + 8), along(numbers + 12)))};
}

[[nodiscard]] inline TriangleNumbers numbers_of(const Triangle& t, double unit) {
    TriangleNumbers n{};
    const auto write = [unit](const Vec3& direction, const Vec3& through, double* into) {
        for (std::size_t a = 0; a < 3; ++a) into[a] = direction[a];
        into[3] = dot(direction, through) / unit;
    };
    write(t.normal, t.corner[0], n.normal);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &from = t.corner[k], &to = t.corner[(k + 1) % 3];
        Vec3 inward = cross(t.normal, to - from);
        inward = (1 / norm(inward)) * inward;
        if (dot(inward, t.corner[(k + 2) % 3] - from) < 0) inward = -inward;
        write(inward, from, n.side[k].inward);
    }
    return n;
}

}  // namespace grainsweep::geometry
