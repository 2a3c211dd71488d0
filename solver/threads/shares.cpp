#include "solver/threads/shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainsweep {

Shares::Shares(int parts) : share_(static_cast<std::size_t>(parts), 1.0 / parts) {}

void Shares::move(std::span<const double> seconds) {
    if (seconds.size() != share_.size()) return;
    constexpr double part_of_the_difference = 0.7;
    const double equal = 1.0 / static_cast<double>(share_.size());
    const double mean = equal * std::accumulate(seconds.begin(), seconds.end(), 0.0);
    for (std::size_t k = 0; k < share_.size(); ++k)
        share_[k] = std::clamp(share_[k] * std::pow(mean / seconds[k], part_of_the_difference), 0.5 * equal, 2 * equal);
    const double sum = std::accumulate(share_.begin(), share_.end(), 0.0);
    for (double& share : share_) share /= sum;
}

}  // namespace grainsweep
