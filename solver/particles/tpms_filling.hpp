// A TPMS cell cut out of a packing: spheres of the shell are frozen as its wall, spheres of the kept side are mobile,
// the others are gone. Centres decide.
#pragma once

#include "solver/geometry/tpms.hpp"
#include "solver/particles/packing.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainsweep::particles {

struct TpmsFilling {
    std::vector<std::array<double, 3>> mobile;  ///< diameters, in the packing's order
    std::vector<std::array<double, 3>> wall;    ///< those a mobile sphere can touch, and the six outermost
    std::size_t wall_spheres = 0;               ///< of the whole shell
};

/// closest: the least distance (diameters) a mobile centre may ever have from a frozen one, see reach.hpp;
/// 0 keeps the whole shell. The outermost frozen spheres along the axes stay, so that whatever is laid around
/// the spheres is laid as around the whole shell.
[[nodiscard]] TpmsFilling fill_tpms(const Packing& packing, const geometry::TpmsShell& shell, double closest);

}  // namespace grainsweep::particles
