// All pairs of points closer than a range, each once, for measurements of a state (not for time steps).
#pragma once

#include "solver/geometry/bounds.hpp"
#include "solver/particles/neighbour_list.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Calls visit(i, j, distance), i < j, for every pair of positions with distance < range, without images.
/// range > 0; finite positions. The order of the calls depends on the positions only.
template <class Visit>
void for_each_near_pair(std::span<const Vec3> position, double range, Visit&& visit) {
    using namespace geometry;
    if (position.empty()) return;
    const auto [low, high] = bounds_around(position);
    const Domain box{low, high, {}};
    std::vector<std::uint32_t> among(position.size());
    std::iota(among.begin(), among.end(), 0U);
    Cells cells;
    const Radii radii{range / 2, {}};
    cells.sort(position, among, radii, 0, box);
    const auto order = cells.order();
    std::vector<Vec3> sorted(position.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = position[order[k]];
    NeighbourList list;
    list.build(cells, sorted, radii, 0, box, [](std::uint32_t, std::uint32_t) { return true; });
    for (std::size_t i = 0; i < list.particles(); ++i)
        for (std::uint32_t entry = list.begin(i); entry < list.end(i); ++entry) {
            const std::size_t j = list[entry].j();
            const double r = norm(sorted[i] - sorted[j]);
            visit(std::size_t{std::min(order[i], order[j])}, std::size_t{std::max(order[i], order[j])}, r);
        }
}

}  // namespace grainsweep::particles
