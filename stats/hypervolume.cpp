#include "stats/hypervolume.hpp"

#include "stats/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::stats {

double expected_positive(double gain, double error) {
    if (!(error > 0)) return std::max(gain, 0.0);
    const double z = gain / error;
    return gain * normal_cdf(z) + error * std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

Hypervolume::Hypervolume(std::array<double, 2> reference, std::array<bool, 2> maximise) : maximise_(maximise) {
    reference_ = {loss(0, reference[0]), loss(1, reference[1])};
}

void Hypervolume::add(std::array<double, 2> point) {
    const std::array<double, 2> added{loss(0, point[0]), loss(1, point[1])};
    if (!(added[0] < reference_[0] && added[1] < reference_[1])) return;
    const auto at = std::ranges::lower_bound(front_, added);
    if (at != front_.begin() && std::prev(at)->at(1) <= added[1]) return;
    const auto beaten = std::find_if(at, front_.end(), [&](const auto& one) { return one[1] < added[1]; });
    front_.insert(front_.erase(at, beaten), added);
}

double Hypervolume::value() const {
    double sum = 0;
    for (std::size_t i = 0; i < front_.size(); ++i) {
        const double end = i + 1 < front_.size() ? front_[i + 1][0] : reference_[0];
        sum += (end - front_[i][0]) * (reference_[1] - front_[i][1]);
    }
    return sum;
}

double Hypervolume::between_points() const {
    double sum = 0;
    for (std::size_t i = 1; i < front_.size(); ++i)
        sum += (front_[i][0] - front_[i - 1][0]) * (front_[i - 1][1] - front_[i][1]);
    return sum;
}

double Hypervolume::expected_gain(const Prediction& first, const Prediction& second) const {
    const auto below = [&](std::size_t k, const Prediction& p, double t) {
        return expected_positive(t - loss(k, p.mean), p.mean_error);
    };
    double sum = 0, before = 0;
    for (std::size_t i = 0; i <= front_.size(); ++i) {
        const double to_here = below(0, first, i < front_.size() ? front_[i][0] : reference_[0]);
        sum += (to_here - before) * below(1, second, i == 0 ? reference_[1] : front_[i - 1][1]);
        before = to_here;
    }
    return sum;
}

}  // namespace grainsweep::stats
