// Infinite plane: distance = (x - point) . normal; the solid lies on the other side.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/lines.hpp"
#include "solver/geometry/number.hpp"

#include <string>

namespace grainsweep::geometry {

/// Plane in units of its user, relative to a centre.
struct PlaneNumbers {
    double normal[3];
    double offset;  ///< normal . point
};

template <class R>
[[gnu::always_inline]] inline Near<R> near(const PlaneNumbers& p, R x, R y, R z) {
    using namespace number;
    const R nx = like(x, p.normal[0]), ny = like(x, p.normal[1]), nz = like(x, p.normal[2]);
    return {fma(nx, x, fma(ny, y, nz * z)) - like(x, p.offset), nx, ny, nz};
}

struct Plane {
    Vec3 point{};
    Vec3 normal{0, 0, 1};  ///< unit; points to the side of the particles

    [[nodiscard]] Closest closest(const Vec3& x) const { return {dot(x - point, normal), normal}; }
    [[nodiscard]] Plane moved(const Vec3& by) const { return {point + by, normal}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3& direction) const { return perpendicular(normal, direction); }
    [[nodiscard]] bool unchanged_by_turn(const Vec3&, const Vec3& axis) const { return parallel(normal, axis); }
    [[nodiscard]] Extent extent(std::size_t) const { return {}; }
    using Numbers = PlaneNumbers;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const {
        Numbers n{};
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        for (std::size_t a = 0; a < 3; ++a) {
            n.normal[a] = normal[a] / length;
            n.offset += n.normal[a] * (point[a] - centre[a]) / unit;
        }
        origin = {};
        return n;
    }
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] std::string flaw() const {
        if (!finite(point) || !finite(normal)) return "a plane must be finite";
        return is_unit(normal) ? "" : "the normal of a plane must have unit length";
    }
};

}  // namespace grainsweep::geometry
