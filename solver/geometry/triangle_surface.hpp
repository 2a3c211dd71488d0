// Surface made of triangles that share corners.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::geometry {

struct TriangleSurface {
    std::vector<Vec3> corners;
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< of corners; the maker of the surface defines their
                                                         ///< orientation
};

}  // namespace grainsweep::geometry
