// Triangles from an STL file, binary or ASCII.
//
// Which of the two it is, its length decides: a binary file is 80 bytes of any header, the number n of triangles and
// 50 n bytes. A header that begins with "solid" makes no text of it. Normals in the file are not read: a triangle has
// its own. STL repeats a corner for every triangle at it; the corners are welded.
#pragma once

#include "solver/geometry/weld.hpp"

#include <string_view>

namespace grainsweep::geometry {

struct StlSurface : WeldedSurface {
    bool binary = false;  ///< what the file was
};

/// The triangles in the contents of a file, m. scale > 0: m per unit of length in the file (files in mm: 1e-3).
/// Throws std::invalid_argument with one sentence where the contents are no STL or have no triangle.
[[nodiscard]] StlSurface read_stl(std::string_view contents, double scale = 1);

}  // namespace grainsweep::geometry
