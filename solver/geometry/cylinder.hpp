// Circular cylinder: a drum from inside, a roller from outside. With a length it is a bore through a plate, or a solid
// with flat ends. Rotation about its axis and sliding along it do not move the surface.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/round_body.hpp"

#include <string>

namespace grainsweep::geometry {

struct Cylinder {
    Vec3 point{};        ///< on the axis; with ends: the middle
    Vec3 axis{0, 0, 1};  ///< unit
    double radius = 0;   ///< m
    Side side = Side::inside;
    double length = std::numeric_limits<double>::infinity();  ///< m

    static void fields(auto& s, auto&& visit) {
        visit(s.point), visit(s.axis), visit(s.radius), visit(s.side), visit(s.length);
    }
    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Cylinder moved(const Vec3& by) const { return {point + by, axis, radius, side, length}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3& direction) const;
    [[nodiscard]] bool unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const;
    [[nodiscard]] Extent extent(std::size_t along) const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] std::string flaw() const;

    /// Returns the point s = 0: the middle, or with ends the centre of the first end.
    [[nodiscard]] Vec3 foot() const;
    /// Returns the meridian in units of `unit` m.
    [[nodiscard]] Meridian meridian(double unit) const;
    using Numbers = Meridian;
    [[nodiscard]] Numbers numbers(const Vec3& centre, double unit, Vec3& origin) const {
        origin = (1 / unit) * (foot() - centre);
        return meridian(unit);
    }
};

}  // namespace grainsweep::geometry
