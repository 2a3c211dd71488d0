// Welding of the corners of triangles.
//
// Corners are welded if they are equal, or nearer than weld_tolerance times the extent (the diagonal of the box around
// all corners). The reason is the rounding in a binary STL file, 6e-8 of a coordinate. Chains of near corners become
// their first corner in the order of x, y, z. So the result depends neither on the order of the triangles nor on the
// order of their corners. A triangle with a height below this distance has no area and is removed.
#pragma once

#include "solver/geometry/triangle_surface.hpp"

#include <cstddef>

namespace grainsweep::geometry {

/// Distance below which two corners are welded, divided by the diagonal of the box around all corners.
inline constexpr double weld_tolerance = 1e-7;
inline constexpr double largest_coordinate = 1e9;  ///< m; its squares and products are finite

struct WeldedSurface {
    TriangleSurface surface;  ///< triangles in the order given, corners ascending in x, y, z
    std::size_t dropped = 0;  ///< triangles without area
    std::size_t merged = 0;   ///< corners near another corner, but not equal to it
};

/// Welds triangles with three finite corners each.
[[nodiscard]] WeldedSurface weld(const std::vector<std::array<Vec3, 3>>& triangles);

}  // namespace grainsweep::geometry
