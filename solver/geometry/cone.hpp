// Frustum of a cone with flat ends: a funnel or hopper from inside (a bore through a plate), a solid from outside.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/round_body.hpp"

#include <string>

namespace grainsweep::geometry {

struct Cone {
    Vec3 base{};                             ///< centre of the first end
    Vec3 axis{0, 0, 1};                      ///< unit, towards the second end
    double base_radius = 0, end_radius = 0;  ///< m; one of them may be 0: a tip
    double length = 0;                       ///< m
    Side side = Side::inside;

    static void fields(auto& s, auto&& visit) {
        visit(s.base), visit(s.axis), visit(s.base_radius), visit(s.end_radius), visit(s.length), visit(s.side);
    }
    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Cone moved(const Vec3& by) const { return {base + by, axis, base_radius, end_radius, length, side}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3&) const { return false; }
    [[nodiscard]] bool unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const;
    [[nodiscard]] Extent extent(std::size_t along) const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] std::string flaw() const;

    /// Returns the meridian in units of `unit` m.
    [[nodiscard]] Meridian meridian(double unit) const;
    using Numbers = Meridian;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const {
        origin = (1 / unit) * (base - centre);
        return meridian(unit);
    }
};

}  // namespace grainsweep::geometry
