// Corners of triangles made one.
//
// Corners are welded where they are equal, and where they are nearer than weld_tolerance times the extent (the diagonal
// of the box around all corners): a binary STL file rounds to 6e-8 of a coordinate. Chains of near corners become one,
// the first of them in the order of x, y, z: the result depends neither on the order of the triangles nor on the order
// of their corners. A triangle less high than that distance has no area and is dropped.
#pragma once

#include "solver/geometry/triangle_surface.hpp"

#include <cstddef>

namespace grainsweep::geometry {

/// Distance below which two corners are one, over the diagonal of the box around all corners.
inline constexpr double weld_tolerance = 1e-7;
inline constexpr double largest_coordinate = 1e9;  ///< m; squares and products of it stay numbers

struct WeldedSurface {
    TriangleSurface surface;  ///< triangles in the order given, corners ascending in x, y, z
    std::size_t dropped = 0;  ///< triangles without area
    std::size_t merged = 0;   ///< corners that were near another one and not equal to it
};

/// Of triangles with three finite corners each.
[[nodiscard]] WeldedSurface weld(const std::vector<std::array<Vec3, 3>>& triangles);

}  // namespace grainsweep::geometry
