// Infinite bar along y: front - thickness <= x <= front, bottom <= z <= top, with two rounded lower edges.
//
// The lower part of the solid is the set of points within edge_radius of the bar shrunk by edge_radius; edge_radius = 0
// gives sharp edges. A point has only one closest point: face, edge and corner never act together.
#pragma once

#include "solver/geometry/closest.hpp"

#include "solver/geometry/number.hpp"

#include <string>

namespace grainsweep::geometry {

/// Bar in units of its user; x from its middle, z from a centre.
struct BarNumbers {
    double half_width, bottom, top, edge_radius;
};

/// Returns the closest point. Below bottom + edge_radius it is computed from a bar thinner by edge_radius on each side.
/// A centre inside is pushed out through the nearest face.
template <class R>
[[gnu::always_inline]] inline Near<R> near(const BarNumbers& b, R x, R, R z) {
    using namespace number;
    const R zero = like(x, 0.0), one = like(x, 1.0), round = like(x, b.edge_radius);
    const R knee = like(x, b.bottom + b.edge_radius);
    const R shrink = where_less(z, knee, round, zero);
    const R half = like(x, b.half_width) - shrink;
    const R px = max(min(x, half), zero - half);
    const R pz = max(min(z, like(x, b.top)), like(x, b.bottom) + shrink);
    const R ox = x - px, oz = z - pz;
    const R length = sqrt(fma(ox, ox, oz * oz));
    const R outside = one * where_less(zero, length, one, zero);
    const R inverse_length = where_less(zero, length, one / max(length, like(x, 1e-30)), zero);
    // inside: depth below the nearest face, whose normal points out
    const R side = where_less(x, zero, zero - one, one);
    const R depth_side = fma(side, x, zero - like(x, b.half_width));
    const R depth_bottom = like(x, b.bottom) - z;
    const R depth_top = z - like(x, b.top);
    const R vertical = max(depth_bottom, depth_top);
    const R up = where_less(depth_bottom, depth_top, one, zero - one);
    const R sideways = where_less(vertical, depth_side, one, zero);
    const R inside = one - outside;
    return {fma(outside, length - shrink, inside * max(vertical, depth_side)),
            fma(ox, inverse_length, inside * sideways * side), zero,
            fma(oz, inverse_length, inside * (one - sideways) * up)};
}

struct Bar {
    double front = 0, thickness = 0, bottom = 0, top = 0;  ///< m
    double edge_radius = 0;                                ///< m, at most half the thickness and the height

    [[nodiscard]] double rear() const { return front - thickness; }
    /// Returns the exact closest point; on the medial axis inside the solid, the point on the front face.
    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Bar moved(const Vec3& by) const {
        return {front + by[0], thickness, bottom + by[2], top + by[2], edge_radius};
    }
    [[nodiscard]] bool unchanged_by_shift(const Vec3& direction) const {
        return direction[0] == 0 && direction[2] == 0;
    }
    [[nodiscard]] bool unchanged_by_turn(const Vec3&, const Vec3&) const { return false; }
    [[nodiscard]] Extent extent(std::size_t axis) const;
    using Numbers = BarNumbers;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] std::string flaw() const;
};

}  // namespace grainsweep::geometry
