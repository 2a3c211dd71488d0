// TPMS cell cut out of a packing: spheres with centres in the shell are frozen as its wall, those on the kept side are
// mobile, the others are removed.
#pragma once

#include "solver/machine/region.hpp"
#include "solver/particles/packing.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainsweep::particles {

struct TpmsFilling {
    std::vector<std::array<double, 3>> mobile;  ///< diameters, in the packing's order
    std::vector<std::array<double, 3>> wall;    ///< spheres that a mobile one can touch, and the six outermost
    std::size_t wall_spheres = 0;               ///< of the whole shell
};

/// Returns the filling; the shell in diameters, its side +1 or -1. closest: smallest distance (diameters) of a mobile
/// centre from a frozen one, see reach.hpp; 0 keeps the whole shell. The outermost frozen spheres along the axes are
/// kept, so that a box around the spheres equals the box around the whole shell.
[[nodiscard]] TpmsFilling fill_tpms(const Packing& packing, const machine::LevelSetRegion& shell, double closest);

}  // namespace grainsweep::particles
