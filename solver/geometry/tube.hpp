// Tube: the wall between two cylinders about one axis, with flat ends. On a plate it holds powder until it is lifted; a
// short tube is a ring.
//
// Coordinates: rho, the distance from the axis, and s, the position along it. The solid is { inner <= rho <= outer, 0
// <= s <= length }, in the half plane of a point x a rectangle. The closest point of this rectangle is the closest of
// all, because rotating a boundary point into the half plane brings it nearer to x.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/number.hpp"

#include <string>

namespace grainsweep::geometry {

/// Tube in units of its user; positions relative to the foot of its axis.
struct TubeNumbers {
    double axis[3];
    double middle, half;  ///< radius of the middle of the wall, half its thickness
    double length;
};

/// Returns the closest point. A centre inside the wall is pushed out through the nearest face.
template <class R>
[[gnu::always_inline]] inline Near<R> near(const TubeNumbers& t, R x, R y, R z) {
    using namespace number;
    const R zero = like(x, 0.0), one = like(x, 1.0), tiny = like(x, 1e-300), half = like(x, t.half);
    const R ax = like(x, t.axis[0]), ay = like(x, t.axis[1]), az = like(x, t.axis[2]), end = like(x, t.length);
    const R s = fma(ax, x, fma(ay, y, az * z));
    const R rx = x - s * ax, ry = y - s * ay, rz = z - s * az;
    const R rho = sqrt(fma(rx, rx, fma(ry, ry, rz * rz)));
    const R q = rho - like(x, t.middle);
    const R from_wall = q - max(zero - half, min(q, half)), from_end = s - max(zero, min(s, end));
    const R length = sqrt(fma(from_wall, from_wall, from_end * from_end));
    const R outside = where_less(zero, length, one, zero), inside = one - outside;
    const R inverse = outside / max(length, tiny);
    // Inside: depth below the nearest face, whose normal points out.
    const R away = where_less(q, zero, zero - one, one);
    const R depth_side = away * q - half;
    const R depth_end = max(zero - s, s - end);
    const R up = where_less(zero - s, s - end, one, zero - one);
    const R sideways = where_less(depth_end, depth_side, one, zero);
    const R n_rho = (inverse * from_wall + inside * sideways * away) / max(rho, tiny);
    const R n_s = inverse * from_end + inside * (one - sideways) * up;
    return {outside * length + inside * max(depth_side, depth_end), fma(n_s, ax, n_rho * rx), fma(n_s, ay, n_rho * ry),
            fma(n_s, az, n_rho * rz)};
}

struct Tube {
    Vec3 base{};                  ///< centre of the first end
    Vec3 axis{0, 0, 1};           ///< unit, towards the second end
    double inner = 0, outer = 0;  ///< radii, m
    double length = 0;            ///< m

    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Tube moved(const Vec3& by) const { return {base + by, axis, inner, outer, length}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3&) const { return false; }
    [[nodiscard]] bool unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const;
    [[nodiscard]] Extent extent(std::size_t along) const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] std::string flaw() const;

    using Numbers = TubeNumbers;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const;
};

}  // namespace grainsweep::geometry
