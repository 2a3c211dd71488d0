// Bar without end along y: front - thickness <= x <= front, bottom <= z <= top, the two lower edges rounded.
//
// The surface is that of the set of points within edge_radius of the bar shrunk by it, below its upper part;
// edge_radius = 0 gives sharp edges. A point has one closest point: face, edge and corner never act together.
#pragma once

#include "solver/geometry/closest.hpp"

#include <string>

namespace grainsweep::geometry {

struct Bar {
    double front = 0, thickness = 0, bottom = 0, top = 0;  ///< m
    double edge_radius = 0;                                ///< m, at most half the thickness and the height

    static void fields(auto& s, auto&& visit) {
        visit(s.front), visit(s.thickness), visit(s.bottom), visit(s.top), visit(s.edge_radius);
    }
    [[nodiscard]] double rear() const { return front - thickness; }
    /// Exact for every point; on the medial axis inside the solid the front face comes first.
    [[nodiscard]] Closest closest(const Vec3& x) const;
    [[nodiscard]] Bar moved(const Vec3& by) const {
        return {front + by[0], thickness, bottom + by[2], top + by[2], edge_radius};
    }
    [[nodiscard]] bool unchanged_by_shift(const Vec3& direction) const { return direction[0] == 0 && direction[2] == 0; }
    [[nodiscard]] bool unchanged_by_turn(const Vec3&, const Vec3&) const { return false; }
    [[nodiscard]] Extent extent(std::size_t axis) const;
    /// What is wrong with it, in one sentence; empty: nothing.
    [[nodiscard]] std::string flaw() const;
};

}  // namespace grainsweep::geometry
