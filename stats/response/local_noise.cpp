#include "stats/response/local_noise.hpp"

#include "stats/response/matern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace grainsweep::stats::response {
namespace {

constexpr double prior_cases = 4;

/// Of distances paired with places, so that equal distances are told apart by the place alone.
using Neighbour = std::pair<double, Eigen::Index>;

double factor(std::vector<Neighbour>& all, Eigen::Index k, const Eigen::VectorXd& squared_scores) {
    const auto nearest = all.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(all.begin(), nearest - 1, all.end());
    std::sort(all.begin(), nearest);  // the sum is the same whatever nth_element leaves
    double sum = prior_cases;
    for (auto i = all.begin(); i != nearest; ++i) sum += squared_scores(i->second);
    return sum / (static_cast<double>(k) + prior_cases);
}

}  // namespace

Eigen::Index LocalNoise::neighbours() const {
    const auto n = static_cast<double>(points.rows());
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::lround(std::sqrt(n) / 1.5)), 1,
                                    std::max<Eigen::Index>(points.rows() - 1, 1));
}

std::int64_t LocalNoise::freedom() const {
    return neighbours() + static_cast<std::int64_t>(prior_cases);
}

Eigen::VectorXd LocalNoise::factors(const Eigen::MatrixXd& at, bool without_self) const {
    Eigen::VectorXd result(at.rows());
    Eigen::ArrayXd squared(points.rows());
    std::vector<Neighbour> all(static_cast<std::size_t>(points.rows()));
    for (Eigen::Index p = 0; p < at.rows(); ++p) {
        squared_distances(points, at.row(p), squared);
        if (without_self) squared(p) = std::numeric_limits<double>::infinity();
        for (Eigen::Index i = 0; i < squared.size(); ++i) all[static_cast<std::size_t>(i)] = {squared(i), i};
        result(p) = factor(all, neighbours(), squared_scores);
    }
    return result;
}

}  // namespace grainsweep::stats::response
