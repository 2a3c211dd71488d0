#include "tests/support/tpms_filling.hpp"

#include "solver/particles/reach.hpp"

#include <algorithm>

namespace grainsweep::particles {

TpmsFilling fill_tpms(const Packing& packing, const machine::LevelSetRegion& shell, double closest) {
    TpmsFilling filling;
    machine::LevelSetRegion solid = shell;
    solid.side = 0;
    for (const auto& x : packing.positions) {
        if (machine::Region{shell}.contains(x)) filling.mobile.push_back(x);
        if (machine::Region{solid}.contains(x)) filling.wall.push_back(x);
    }
    filling.wall_spheres = filling.wall.size();
    if (closest <= 0 || filling.wall.empty()) return filling;

    auto stays = reachable(filling.wall, filling.mobile, closest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto along = [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; };
        const auto [low, high] = std::ranges::minmax_element(filling.wall, along);
        stays[static_cast<std::size_t>(low - filling.wall.begin())] = true;
        stays[static_cast<std::size_t>(high - filling.wall.begin())] = true;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < filling.wall.size(); ++i)
        if (stays[i]) filling.wall[kept++] = filling.wall[i];
    filling.wall.resize(kept);
    return filling;
}

}  // namespace grainsweep::particles
