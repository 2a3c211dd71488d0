// Edges of a box, for pictures of several scenes.
#pragma once

#include "solver/scenes/values.hpp"

namespace grainsweep {

/// Adds the eight corners and twelve edges of the box; returns the index of the corner `low`. A corner lies at the high
/// end of axis a if bit a of its index minus the returned index is set.
std::int32_t add_box(const std::array<double, 3>& low, const std::array<double, 3>& high, WallSurface& surface);

}  // namespace grainsweep
