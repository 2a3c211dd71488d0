#include "solver/coupling/near_pairs.hpp"

#include <algorithm>
#include <numeric>

namespace grainsweep::coupling {

const std::vector<Pair>& NearPairs::find(const std::vector<Vec3>& position, double range) {
    pairs_.clear();
    if (position.size() < 2) return pairs_;
    if (all_.size() != position.size()) {
        all_.resize(position.size());
        std::iota(all_.begin(), all_.end(), 0U);
    }
    const particles::Radii radii{0.5 * range, {}};
    cells_.sort(position, all_, radii, 0, domain_);
    const auto order = cells_.order();
    sorted_.resize(position.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted_[k] = position[order[k]];
    list_.build(cells_, sorted_, radii, 0, domain_, [](std::uint32_t, std::uint32_t) { return true; });
    for (std::size_t i = 0; i < list_.particles(); ++i)
        for (std::uint32_t entry = list_.begin(i); entry < list_.end(i); ++entry)
            pairs_.push_back(std::minmax(order[i], order[list_[entry].j()]));
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    return pairs_;
}

}  // namespace grainsweep::coupling
