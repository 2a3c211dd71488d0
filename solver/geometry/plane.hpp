// Infinite plane: distance = (x - point) . normal; the solid lies on the other side.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/lines.hpp"

#include <string>

namespace grainsweep::geometry {

struct Plane {
    Vec3 point{};
    Vec3 normal{0, 0, 1};  ///< unit; particles are on the side it points to

    static void fields(auto& s, auto&& visit) { visit(s.point), visit(s.normal); }
    [[nodiscard]] Closest closest(const Vec3& x) const { return {dot(x - point, normal), normal}; }
    [[nodiscard]] Plane moved(const Vec3& by) const { return {point + by, normal}; }
    [[nodiscard]] bool unchanged_by_shift(const Vec3& direction) const { return perpendicular(normal, direction); }
    [[nodiscard]] bool unchanged_by_turn(const Vec3&, const Vec3& axis) const { return parallel(normal, axis); }
    [[nodiscard]] Extent extent(std::size_t) const { return {}; }
    /// What is wrong with it, in one sentence; empty: nothing.
    [[nodiscard]] std::string flaw() const {
        if (!finite(point) || !finite(normal)) return "a plane must be finite";
        return is_unit(normal) ? "" : "the normal of a plane must have unit length";
    }
};

}  // namespace grainsweep::geometry
