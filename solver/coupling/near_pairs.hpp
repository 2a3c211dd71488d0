// Pairs of particles nearer than a range, also across periodic sides.
#pragma once

#include "solver/coupling/walls.hpp"
#include "solver/particles/neighbour_list.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace grainsweep::coupling {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

class NearPairs {
public:
    explicit NearPairs(const Walls& box) : domain_{box.low, box.high, box.periodic} {}

    /// Returns all pairs i < j with |x_i - x_j| < range, ascending. Positions must be finite and inside the box.
    const std::vector<Pair>& find(const std::vector<Vec3>& position, double range);
    /// Returns the shortest x_i - x_j.
    [[nodiscard]] Vec3 separation(const Vec3& xi, const Vec3& xj) const { return domain_.separation(xi, xj); }

private:
    particles::Domain domain_;
    particles::Cells cells_;
    particles::NeighbourList list_;
    std::vector<std::uint32_t> all_;
    std::vector<Vec3> sorted_;
    std::vector<Pair> pairs_;
};

}  // namespace grainsweep::coupling
