// Closest point of a body of revolution with a straight meridian and two flat ends. The body is the frustum of a cone,
// or a cylinder, touched from outside, or a bore of this shape in a plate.
//
// Coordinates: rho, the distance from the axis, and s, the position along it. The solid is { g (rho - r(s)) >= 0, 0 <=
// s <= length }, g = 1 inside, -1 outside, r(s) = base + slope s. In the half plane of the point x the solid is convex;
// its boundary is a segment and two rays. The closest point in this half plane is the closest of all, because rotating
// a boundary point into the half plane brings it nearer to x. The normal points from the closest point to x, or the
// opposite way if x is in the solid.
#pragma once

#include "solver/geometry/number.hpp"

namespace grainsweep::geometry {

/// Meridian, relative to the foot of the axis in the plane s = 0.
struct Meridian {
    double axis[3];
    double base, end;      ///< radius at s = 0 and at s = length
    double length;         ///< infinite: a cylinder without ends
    double along, across;  ///< components of the unit vector from the base to the end, along the axis and away from it
    double slant;          ///< distance between both
    double side;           ///< g
};

/// Returns the closest point of a cylinder without ends; (x, y, z) from a point of its axis.
template <class R>
[[gnu::always_inline]] inline Near<R> near_cylinder(const Meridian& m, R x, R y, R z) {
    using namespace number;
    const R ax = like(x, m.axis[0]), ay = like(x, m.axis[1]), az = like(x, m.axis[2]), side = like(x, m.side);
    const R s = fma(ax, x, fma(ay, y, az * z));
    const R rx = x - s * ax, ry = y - s * ay, rz = z - s * az;
    const R rho = sqrt(fma(rx, rx, fma(ry, ry, rz * rz)));
    const R outward = (like(x, 0.0) - side) / max(rho, like(x, 1e-300));
    return {side * (like(x, m.base) - rho), outward * rx, outward * ry, outward * rz};
}

/// Returns the closest point of a body with ends; (x, y, z) from the foot of its axis.
template <class R>
[[gnu::always_inline]] inline Near<R> near_round_body(const Meridian& m, R x, R y, R z) {
    using namespace number;
    const R zero = like(x, 0.0), one = like(x, 1.0), tiny = like(x, 1e-300);
    const R ax = like(x, m.axis[0]), ay = like(x, m.axis[1]), az = like(x, m.axis[2]), g = like(x, m.side);
    const R s = fma(ax, x, fma(ay, y, az * z));
    const R rx = x - s * ax, ry = y - s * ay, rz = z - s * az;
    const R rho = sqrt(fma(rx, rx, fma(ry, ry, rz * rz)));

    // From the segment: height above it with the outward normal g (-along, across) in (rho, s), and the excess beyond
    // its ends.
    const R along = like(x, m.along), across = like(x, m.across), from_base = rho - like(x, m.base);
    const R height = g * (across * s - along * from_base);
    const R place = fma(across, from_base, along * s);
    const R beyond = place - max(zero, min(place, like(x, m.slant)));
    R v_rho = fma(beyond, across, zero - g * height * along), v_s = fma(beyond, along, g * height * across);
    R least = fma(height, height, beyond * beyond);
    // From the ends: rays on the side of the solid.
    const R to_end = s - like(x, m.length), from_end = rho - like(x, m.end);
    const R f_base = g * min(zero, g * from_base), f_end = g * min(zero, g * from_end);
    const R d_base = fma(f_base, f_base, s * s), d_end = fma(f_end, f_end, to_end * to_end);
    v_rho = where_less(d_base, least, f_base, v_rho);
    v_s = where_less(d_base, least, s, v_s);
    least = min(d_base, least);
    v_rho = where_less(d_end, least, f_end, v_rho);
    v_s = where_less(d_end, least, to_end, v_s);
    least = min(d_end, least);

    const R distance = sqrt(least);
    // In the solid if the point is below the segment and between the ends.
    const R deepest = max(height, max(zero - s, to_end));
    const R sign = where_less(zero, deepest, one, zero - one);
    const R inverse = sign / max(distance, tiny);
    const R n_rho = inverse * v_rho / max(rho, tiny), n_s = inverse * v_s;
    return {sign * distance, fma(n_s, ax, n_rho * rx), fma(n_s, ay, n_rho * ry), fma(n_s, az, n_rho * rz)};
}

template <class R>
[[gnu::always_inline]] inline Near<R> near(const Meridian& m, R x, R y, R z) {
    return m.length < 1e300 ? near_round_body(m, x, y, z) : near_cylinder(m, x, y, z);
}

}  // namespace grainsweep::geometry
