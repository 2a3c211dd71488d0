// Which frozen spheres a mobile one can ever touch: a proof by flooding the space open to mobile centres.
//
// All spheres have diameter 1. While no mobile centre comes nearer than `closest` to a frozen one, it moves
// (continuously) through the complement of the balls of radius `closest` around the frozen centres. That
// space is covered by cubes of edge h = 1/8: a cube whose every point is inside one ball (centre nearer than
// closest - h sqrt(3)/2) is shut, all others count as open, and openness spreads through faces (a path
// through an edge or corner is in all cubes that meet there, so faces suffice). Flooded from the starting
// centres and from everywhere far from frozen spheres, the open cubes contain every place a mobile centre can
// reach. A frozen sphere farther than 1 from all of them is never touched.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// For each frozen centre whether a mobile one can come within a diameter of it (true) or never can (false).
/// Unit: diameters; 0 < closest <= 1; everything outside the box of the frozen centres counts as open.
[[nodiscard]] std::vector<bool> reachable(std::span<const std::array<double, 3>> frozen,
                                          std::span<const std::array<double, 3>> mobile, double closest);

}  // namespace grainsweep::particles
