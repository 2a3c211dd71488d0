// Surface f = 0 inside a box as triangles, for pictures.
//
// Surface nets (Gibson 1998, doi 10.1007/BFb0056277). Every cell of a grid in which f changes sign has a corner, at the
// mean of the points where its edges cross the surface. Every such edge has a quadrilateral around it. On the faces of
// the box the cells are flat, so that the rim of the surface lies in the faces. The error of the corners is O(h^2). If
// two sheets pass through one cell, they share its corner.
#pragma once

#include "solver/geometry/triangle_surface.hpp"

#include <functional>

namespace grainsweep::geometry {

/// Returns triangles that are counter-clockwise as seen from the side f > 0. cells >= 1: of the grid along each axis of
/// the box. Throws std::invalid_argument otherwise.
[[nodiscard]] TriangleSurface level_surface(const std::function<double(const Vec3&)>& f, const Vec3& low,
                                            const Vec3& high, int cells);

}  // namespace grainsweep::geometry
