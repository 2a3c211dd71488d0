// Opening through which a cell empties downwards.
#pragma once

#include "solver/geometry/tpms.hpp"

namespace grainsweep::geometry {

/// Returns the diameter of the largest disc of the kept side in the lower face z = 0, with its centre in the face. It
/// is computed on a grid of 256 x 256 points, so the error is below edge/256; 0 if the face is closed. In the unit of
/// the edge.
[[nodiscard]] double outlet_diameter(const TpmsShell& shell);

}  // namespace grainsweep::geometry
