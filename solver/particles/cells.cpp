#include "solver/particles/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::particles {
namespace {

/// Level of a radius below the largest one: 0 within a factor of two, 1 within four ...
std::size_t steps_below(double radius, double largest) {
    std::size_t steps = 0;
    for (double floor = largest / 2; radius <= floor; floor /= 2) ++steps;
    return steps;
}

}  // namespace

std::array<std::int32_t, 3> Cells::Level::cell(const Vec3& x) const {
    std::array<std::int32_t, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double q = (x[k] - low[k]) * inverse_edge[k];
        c[k] = std::clamp(q > 0 ? static_cast<std::int32_t>(q) : 0, 0, count[k] - 1);
    }
    return c;
}

void Cells::lay_grids(std::span<const Vec3> position, std::span<const std::uint32_t> among, const Radii& radii,
                      double skin, const Domain& domain) {
    Vec3 low = domain.low;
    Vec3 high = domain.high;
    double largest = radii.common;
    double smallest = radii.common;
    if (!radii.each.empty()) {
        largest = 0;
        smallest = std::numeric_limits<double>::infinity();
        for (const auto i : among) {
            largest = std::max(largest, radii.each[i]);
            smallest = std::min(smallest, radii.each[i]);
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {  // open directions: no cells where there are no particles
        if (domain.periodic[k]) continue;
        double least = domain.high[k];
        double most = domain.low[k];
        for (const auto i : among) {
            least = std::min(least, position[i][k]);
            most = std::max(most, position[i][k]);
        }
        low[k] = least;
        high[k] = std::max(most, least);
    }
    const std::size_t levels = among.empty() ? 1 : steps_below(smallest, largest) + 1;
    levels_.resize(levels);
    level_radius_.assign(levels, 0);
    for (const auto i : among) {
        double& r = level_radius_[levels - 1 - steps_below(radii[i], largest)];
        r = std::max(r, radii[i]);
    }
    for (std::size_t l = 0; l < levels; ++l) {
        auto& level = levels_[l];
        level.low = low;
        double edge = 2 * level_radius_[l] + skin;
        // Sparse clouds: wider cells rather than more of them than a few per particle.
        const double most_cells = 4.0 * static_cast<double>(among.size()) + 64;
        for (;;) {
            double cells = 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const double n = edge > 0 ? std::floor((high[k] - low[k]) / edge) : 1.0;
                level.count[k] = static_cast<std::int32_t>(std::clamp(n, 1.0, 1e6));
                cells *= level.count[k];
            }
            if (cells <= most_cells) break;
            edge *= 1.3;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double length = high[k] - low[k];
            level.inverse_edge[k] = length > 0 ? level.count[k] / length : 0.0;
        }
        level.start.assign(level.index(0, 0, level.count[2]) + 1, 0);
    }
}

void Cells::sort(std::span<const Vec3> position, std::span<const std::uint32_t> among, const Radii& radii, double skin,
                 const Domain& domain) {
    lay_grids(position, among, radii, skin, domain);
    const double largest = levels_.empty() ? 0.0 : level_radius_.back();
    const std::size_t levels = levels_.size();
    const auto level_of = [&](std::uint32_t i) { return levels - 1 - steps_below(radii[i], largest); };

    // Counting sort: stable, so the order is a function of positions and the previous order alone.
    slot_.resize(among.size());
    for (std::size_t k = 0; k < among.size(); ++k) {
        auto& level = levels_[levels == 1 ? 0 : level_of(among[k])];
        const auto [x, y, z] = level.cell(position[among[k]]);
        slot_[k] = static_cast<std::uint32_t>(level.index(x, y, z));
        ++level.start[slot_[k] + 1];
    }
    std::uint32_t total = 0;
    level_begin_.resize(levels);
    for (std::size_t l = 0; l < levels; ++l) {
        level_begin_[l] = total;
        for (auto& entry : levels_[l].start) entry = total += entry;
    }
    order_.resize(among.size());
    std::vector<std::vector<std::uint32_t>> next(levels);
    for (std::size_t l = 0; l < levels; ++l) next[l] = levels_[l].start;
    for (std::size_t k = 0; k < among.size(); ++k) {
        const std::size_t l = levels == 1 ? 0 : level_of(among[k]);
        order_[next[l][slot_[k]]++] = among[k];
    }
}

}  // namespace grainsweep::particles
