#include "solver/particles/neighbour_list.hpp"

namespace grainsweep::particles {

using namespace geometry;

void NeighbourList::build_by_brute_force(std::span<const Vec3> position, const Radii& radii, double skin,
                                         const Domain& domain) {
    const auto n = static_cast<std::uint32_t>(position.size());
    const auto shifts = domain.image_shifts();
    first_.assign(n + 1U, 0);
    entries_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
        first_[i] = static_cast<std::uint32_t>(entries_.size());
        for (std::uint32_t j = i + 1; j < n; ++j) {
            for (std::uint32_t image = 0; image < 27; ++image) {
                const std::array<std::uint32_t, 3> digit = {image % 3, image / 3 % 3, image / 9};
                bool exists = true;
                for (std::size_t k = 0; k < 3; ++k) exists = exists && (domain.periodic[k] || digit[k] == 1);
                if (!exists) continue;
                const Vec3 d = position[i] - shifts[image] - position[j];
                const double reach = radii[i] + radii[j] + skin;
                if (dot(d, d) < reach * reach) entries_.push_back(Neighbour::of(j, image));
            }
        }
    }
    first_[n] = static_cast<std::uint32_t>(entries_.size());
}

}  // namespace grainsweep::particles
