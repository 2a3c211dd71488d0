#include "solver/threads/shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainsweep {

namespace {

// Steps, as parts of a share. With the smallest ones a share wanders about where it should be; growing
// from the first one, cores of which one is half as fast as the other end together, to 1 %, after six.
constexpr double first_step = 0.02, smallest_step = 0.004, largest_step = 0.1;
constexpr double growth = 1.5, shrinkage = 0.5;
constexpr double little = 0.2;  ///< lateness that tells nothing: of two alike, one ends last as often as the other

}  // namespace

Shares::Shares(int parts)
    : share_(static_cast<std::size_t>(parts), 1.0 / parts),
      step_(static_cast<std::size_t>(parts), Step{first_step, 0}) {}

void Shares::move(std::span<const double> lateness) {
    if (lateness.size() != share_.size()) return;
    const double equal = 1.0 / static_cast<double>(share_.size());
    for (std::size_t k = 0; k < share_.size(); ++k) {
        const int direction = std::abs(lateness[k]) < little ? 0 : lateness[k] > 0 ? -1 : 1;
        Step& step = step_[k];
        if (direction != 0 && direction == step.direction)
            step.size = std::min(step.size * growth, largest_step);
        else if (step.direction != 0)
            step.size = std::max(step.size * shrinkage, smallest_step);
        step.direction = direction;
        share_[k] = std::clamp(share_[k] * (1 + direction * step.size), 0.5 * equal, 2 * equal);
    }
    const double sum = std::accumulate(share_.begin(), share_.end(), 0.0);
    for (double& share : share_) share /= sum;
}

}  // namespace grainsweep
