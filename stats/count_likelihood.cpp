#include "stats/count_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::stats {
namespace {

/// Returns t of the header.
double spread_of(const CountTarget& target, const Prediction& prediction) {
    constexpr double less_than_all = 1 - 1e-9;  // a probability with the variance P (1 - P) is 0 or 1
    const double run = prediction.mean * (1 - prediction.mean);
    if (!(run > 0)) return 0;
    const double model = std::min(prediction.mean_error * prediction.mean_error, less_than_all * run);
    const double share = 4 * target.discrepancy * target.discrepancy;
    return (model + share * (run - model)) / ((run - model) * (1 - share));
}

double log_of_count(const CountTarget& target, double p, double t) {
    double sum = std::lgamma(static_cast<double>(target.of) + 1) - std::lgamma(static_cast<double>(target.count) + 1) -
                 std::lgamma(static_cast<double>(target.of - target.count) + 1);
    for (std::size_t i = 0; i < target.count; ++i) sum += std::log(p + static_cast<double>(i) * t);
    for (std::size_t i = 0; i < target.of - target.count; ++i) sum += std::log(1 - p + static_cast<double>(i) * t);
    for (std::size_t i = 0; i < target.of; ++i) sum -= std::log1p(static_cast<double>(i) * t);
    return sum;
}

void check_count(const CountTarget& target) {
    if (target.of == 0 || target.count > target.of || !(target.discrepancy >= 0 && target.discrepancy < 0.5))
        throw std::invalid_argument("a count needs 0 <= count <= of, of > 0 and a discrepancy below 1/2");
}

}  // namespace

std::vector<double> log_likelihood_of_count(const CountTarget& target, std::span<const Prediction> predictions) {
    check_count(target);
    std::vector<double> result;
    for (const auto& one : predictions) result.push_back(log_of_count(target, one.mean, spread_of(target, one)));
    return result;
}

std::vector<double> implausibilities_of_count(const CountTarget& target, std::span<const Prediction> predictions) {
    check_count(target);
    const double share = static_cast<double>(target.count) / static_cast<double>(target.of);
    std::vector<double> result;
    for (const auto& one : predictions) {
        const double t = spread_of(target, one);
        const double less = log_of_count(target, share, t) - log_of_count(target, one.mean, t);
        result.push_back(std::sqrt(std::max(2 * less, 0.0)));
    }
    return result;
}

}  // namespace grainsweep::stats
