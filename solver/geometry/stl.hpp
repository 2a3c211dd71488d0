// Triangles from an STL file, binary or ASCII.
//
// The length of the file decides between the two: a binary file has 80 bytes of any header, the number n of triangles
// and 50 n bytes. Its header may begin with "solid". Normals in the file are ignored and computed from the corners. STL
// repeats a corner for every triangle; equal corners are welded.
#pragma once

#include "solver/geometry/weld.hpp"

#include <string_view>

namespace grainsweep::geometry {

struct StlSurface : WeldedSurface {
    bool binary = false;  ///< the file was binary
};

/// Returns the triangles in the contents of a file, m. scale > 0: m per unit of length in the file (files in mm: 1e-3).
/// Throws std::invalid_argument with one sentence if the contents are no STL or have no triangle.
[[nodiscard]] StlSurface read_stl(std::string_view contents, double scale = 1);

}  // namespace grainsweep::geometry
