// The opening through which a cell empties downwards.
#pragma once

#include "solver/geometry/tpms.hpp"

namespace grainsweep::geometry {

/// Diameter of the largest disc of the kept side in the lower face z = 0, its centre in the face: the nearest point
/// that is not kept is that far away. Found on a grid of 256 x 256 points, so within edge/256; 0 where the face is
/// shut. In the unit of the edge.
[[nodiscard]] double outlet_diameter(const TpmsShell& shell);

}  // namespace grainsweep::geometry
