// A surface made of triangles that share corners.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::geometry {

struct TriangleSurface {
    std::vector<Vec3> corners;
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< of corners; which way round is the maker's to say
};

}  // namespace grainsweep::geometry
