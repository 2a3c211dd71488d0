// Bar without end along y: rear <= x <= front, bottom <= z <= top, the two lower edges rounded.
//
// The surface is that of the set of points within edge_radius of the bar shrunk by it, below its upper part;
// edge_radius = 0 gives sharp edges. A point has one closest point: face, edge and corner never act together.
#pragma once

#include "solver/geometry/closest.hpp"

namespace grainsweep::geometry {

struct Bar {
    double rear = 0, front = 0, bottom = 0, top = 0;  ///< m
    double edge_radius = 0;                           ///< m, at most half the thickness and the height

    /// Exact for every point; on the medial axis inside the solid the front face comes first.
    [[nodiscard]] Closest closest(const Vec3& x) const;
};

}  // namespace grainsweep::geometry
