// Frozen spheres that a mobile one can ever touch, proven by flooding the space open to mobile centres.
//
// All spheres have diameter 1. As long as no mobile centre comes nearer than `closest` to a frozen one, it moves
// continuously outside the balls of radius `closest` around the frozen centres. Cubes of edge h = 1/8 cover this space.
// A cube is closed if all its points are inside one ball (centre nearer than closest - h sqrt(3)/2); all other cubes
// are open. Flooding passes from cube to cube through faces. Faces suffice, because a path through an edge or corner is
// in all cubes that meet there. The flood starts from the initial centres and from all space far from frozen spheres.
// The flooded cubes contain every place that a mobile centre can reach. A frozen sphere farther than 1 from all of them
// is never touched.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Returns for each frozen centre whether a mobile one can come within a diameter of it. Unit: diameters; 0 < closest
/// <= 1. Space outside the box of the frozen centres counts as open.
[[nodiscard]] std::vector<bool> reachable(std::span<const std::array<double, 3>> frozen,
                                          std::span<const std::array<double, 3>> mobile, double closest);

}  // namespace grainsweep::particles
