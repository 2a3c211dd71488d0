// Tube: the wall between two cylinders about one axis, with flat ends. What stands on a plate holds powder until it is
// lifted; a ring is a short one.
//
// With rho, s the distance from the axis and the place along it, the solid is { inner <= rho <= outer, 0 <= s <= length
// }: in the half plane of a point a rectangle, whose closest point is the closest of all, for turning a boundary point
// into the half plane of x brings it nearer.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/number.hpp"

#include <string>

namespace grainsweep::geometry {

/// A tube in units; positions relative to the foot of its axis.
struct TubeNumbers {
    double axis[3];
    double middle, half;  ///< radius of the middle of the wall, half its thickness
    double length;
};

/// A centre inside the wall is pushed out through the nearest face.
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

    static void fields(auto& s, auto&& visit) {
        visit(s.base), visit(s.axis), visit(s.inner), visit(s.outer), visit(s.length);
    }
    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Tube moved(const Vec3& by) const { return {base + by, axis, inner, outer, length}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3&) const { return false; }
    [[nodiscard]] bool unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const;
    [[nodiscard]] Extent extent(std::size_t along) const;
    /// What is wrong with it, in one sentence; empty: nothing.
    [[nodiscard]] std::string flaw() const;

    using Numbers = TubeNumbers;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const;
};

}  // namespace grainsweep::geometry
