// Verlet's half list: for each particle i, in cell order, the partners j > i whose surfaces are nearer than the skin:
// |x_i - x_j| < R_i + R_j + skin. (Verlet 1967, Phys. Rev. 159, 98)
//
// Every contact is in the list as long as no particle has moved farther than skin/2 since it was built: two surfaces
// approach by at most the sum of two displacements. An entry has j and its periodic image, 27 + 5 bits; the branch
// vector is x_i - (x_j + image shift).
#pragma once

#include "solver/particles/cells.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::particles {

struct Neighbour {
    std::uint32_t bits = 0;

    static constexpr std::uint32_t image_bits = 5;
    static constexpr std::uint32_t most_particles = 1U << (32 - image_bits);
    static constexpr std::uint32_t own_image = 13;

    static constexpr Neighbour of(std::uint32_t j, std::uint32_t image) { return {(j << image_bits) | image}; }
    [[nodiscard]] constexpr std::uint32_t j() const { return bits >> image_bits; }
    [[nodiscard]] constexpr std::uint32_t image() const { return bits & ((1U << image_bits) - 1); }
};

class NeighbourList {
public:
    /// Builds the list. Particles must be in the order of `cells`. Pairs with `pair_matters(i, j)` false are not
    /// listed.
    template <class PairMatters>
    void build(const Cells& cells, std::span<const Vec3> position, const Radii& radii, double skin,
               const Domain& domain, PairMatters&& pair_matters);

    [[nodiscard]] std::size_t particles() const { return first_.empty() ? 0 : first_.size() - 1; }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    [[nodiscard]] std::uint32_t begin(std::size_t i) const { return first_[i]; }
    [[nodiscard]] std::uint32_t end(std::size_t i) const { return first_[i + 1]; }
    [[nodiscard]] Neighbour operator[](std::size_t entry) const { return entries_[entry]; }

    template <class Archive>
    void save(Archive& out) const {
        out.put(first_);
        out.put(entries_);
    }
    /// Restores a list. Throws std::invalid_argument if it is no list of `particles` particles.
    template <class Archive>
    void restore(Archive& in, std::size_t particles) {
        in.get(first_);
        in.get(entries_);
        Archive::require(first_.size() == particles + 1 && first_.front() == 0 && first_.back() == entries_.size());
        for (std::size_t i = 0; i < particles; ++i) Archive::require(first_[i] <= first_[i + 1]);
        for (const Neighbour entry : entries_) Archive::require(entry.j() < particles && entry.image() < 27);
    }

private:
    std::vector<std::uint32_t> first_;
    std::vector<Neighbour> entries_;
};

template <class PairMatters>
void NeighbourList::build(const Cells& cells, std::span<const Vec3> position, const Radii& radii, double skin,
                          const Domain& domain, PairMatters&& pair_matters) {
    using namespace geometry;
    const auto n = static_cast<std::uint32_t>(position.size());
    const auto shifts = domain.image_shifts();
    const auto levels = cells.levels();
    first_.resize(n + 1U);
    entries_.clear();
    std::size_t own = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        first_[i] = static_cast<std::uint32_t>(entries_.size());
        while (own + 1 < levels.size() && i >= cells.level_begin(own + 1)) ++own;
        const Vec3 xi = position[i];
        const double reach_i = radii[i] + skin;
        const auto take = [&](std::uint32_t from, std::uint32_t to, std::uint32_t image) {
            const Vec3 x = xi - shifts[image];
            for (std::uint32_t j = from > i ? from : i + 1; j < to; ++j) {
                const Vec3 d = x - position[j];
                const double reach = reach_i + radii[j];
                if (dot(d, d) < reach * reach && pair_matters(i, j)) entries_.push_back(Neighbour::of(j, image));
            }
        };
        for (std::size_t l = own; l < levels.size(); ++l) {
            const auto& grid = levels[l];
            const auto c = grid.cell(xi);
            for (std::int32_t dz = -1; dz <= 1; ++dz)
                for (std::int32_t dy = -1; dy <= 1; ++dy) {
                    // A cell beyond a periodic face is the cell at the other end, displaced by a period.
                    std::uint32_t image = 0;
                    const auto beyond = [&](std::int32_t& cell, std::size_t axis, std::uint32_t stride) {
                        const std::int32_t count = grid.count[axis];
                        std::uint32_t step = 1;
                        if (cell < 0) {
                            if (!domain.periodic[axis]) return false;
                            cell += count;
                            step = 0;
                        } else if (cell >= count) {
                            if (!domain.periodic[axis]) return false;
                            cell -= count;
                            step = 2;
                        }
                        image += step * stride;
                        return true;
                    };
                    std::int32_t y = c[1] + dy;
                    std::int32_t z = c[2] + dz;
                    if (!beyond(y, 1, 3) || !beyond(z, 2, 9)) continue;
                    const bool wraps = domain.periodic[0] && (c[0] == 0 || c[0] == grid.count[0] - 1);
                    if (!wraps) {  // cells of a row are contiguous: one range of particles
                        const std::int32_t from = c[0] > 0 ? c[0] - 1 : 0;
                        const std::int32_t to = c[0] + 1 < grid.count[0] ? c[0] + 1 : grid.count[0] - 1;
                        take(grid.start[grid.index(from, y, z)], grid.start[grid.index(to, y, z) + 1], image + 1);
                        continue;
                    }
                    const std::uint32_t image_yz = image;
                    for (std::int32_t dx = -1; dx <= 1; ++dx) {
                        image = image_yz;
                        std::int32_t x = c[0] + dx;
                        beyond(x, 0, 1);
                        const std::size_t cell = grid.index(x, y, z);
                        take(grid.start[cell], grid.start[cell + 1], image);
                    }
                }
        }
    }
    first_[n] = static_cast<std::uint32_t>(entries_.size());
}

}  // namespace grainsweep::particles
