// Sorting of particles by cells, so that neighbours in space are neighbours in memory.
//
// Particles are divided into levels by size; the radii of a level differ by less than a factor of two. Each level has
// its own grid, whose cells are at least as wide as the range of a pair whose larger partner belongs to the level:
//     edge >= 2 R_max(level) + skin.
// Partners of this level therefore lie within 27 cells around a particle of any size. The sorted
// order is (level from small to large, cell, previous order); equal spheres make one level.
#pragma once

#include "solver/geometry/domain.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::particles {

using geometry::Domain;
using geometry::Vec3;

/// Radii of all particles: one each, or one for all if `each` is empty.
struct Radii {
    double common = 0;
    std::span<const double> each;
    [[nodiscard]] double operator[](std::size_t i) const { return each.empty() ? common : each[i]; }
};

class Cells {
public:
    struct Level {
        std::array<std::int32_t, 3> count{};  ///< cells per axis
        Vec3 low{};
        Vec3 inverse_edge{};
        std::vector<std::uint32_t> start;  ///< first particle of each cell, x fastest; one more at the end

        [[nodiscard]] std::array<std::int32_t, 3> cell(const Vec3& x) const;
        [[nodiscard]] std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
            return static_cast<std::size_t>(x) +
                   static_cast<std::size_t>(count[0]) *
                       (static_cast<std::size_t>(y) + static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(z));
        }
    };

    /// Sorts the particles in `among` (positions inside periodic faces): order()[k] is the k-th particle.
    void sort(std::span<const Vec3> position, std::span<const std::uint32_t> among, const Radii& radii, double skin,
              const Domain& domain);

    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
    [[nodiscard]] std::span<const Level> levels() const { return levels_; }  ///< from small to large
    [[nodiscard]] std::uint32_t level_begin(std::size_t level) const { return level_begin_[level]; }

private:
    void lay_grids(std::span<const Vec3> position, std::span<const std::uint32_t> among, const Radii& radii,
                   double skin, const Domain& domain);

    std::vector<Level> levels_;
    std::vector<std::uint32_t> level_begin_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> slot_;
    std::vector<double> level_radius_;
};

}  // namespace grainsweep::particles
