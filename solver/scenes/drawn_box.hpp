// The edges of a box, as pictures of several scenes show it.
#pragma once

#include "solver/scenes/values.hpp"

namespace grainsweep {

/// Adds the eight corners and twelve edges of the box; returns the index of the corner `low`. Corner c lies at the high
/// end of axis a where bit a of c - that index is set.
std::int32_t add_box(const std::array<double, 3>& low, const std::array<double, 3>& high, WallSurface& surface);

}  // namespace grainsweep
