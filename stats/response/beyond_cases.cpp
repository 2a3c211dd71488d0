#include "stats/response/beyond_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace grainsweep::stats::response {
namespace {

constexpr double far = 1.5;
constexpr double most_missed = 0.1, most_missed_without_end = 0.03;
constexpr double beyond_unforeseen = 3, unforeseen_far_out = 0.3;

/// The cases in the order of each feature.
std::vector<std::vector<Eigen::Index>> orders_of(const Eigen::MatrixXd& x) {
    std::vector<std::vector<Eigen::Index>> orders;
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
        auto& order = orders.emplace_back(static_cast<std::size_t>(x.rows()));
        std::iota(order.begin(), order.end(), Eigen::Index{0});
        std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return x(i, j); });
    }
    return orders;
}

/// Returns whether the points q end much farther from the outermost case of a feature than that is from the eighth.
bool reaches_far_out(const Eigen::MatrixXd& x, const std::vector<std::vector<Eigen::Index>>& orders,
                     const Eigen::MatrixXd& q) {
    const auto inner = std::min<std::size_t>(2 * outermost, static_cast<std::size_t>(x.rows())) - 1;
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
        const auto& order = orders[static_cast<std::size_t>(j)];
        const double low = x(order.front(), j), high = x(order.back(), j);
        const double from_low = x(order[inner], j), from_high = x(order[order.size() - 1 - inner], j);
        if (low - q.col(j).minCoeff() > far * (from_low - low) || q.col(j).maxCoeff() - high > far * (high - from_high))
            return true;
    }
    return false;
}

}  // namespace

/// What the model without the cases of each end misses of them.
std::vector<BeyondCases::Edge> BeyondCases::edges_of(const Kriging& model, const Eigen::MatrixXd& inverse,
                                                     const std::vector<std::vector<Eigen::Index>>& ends, double v) {
    std::set<Eigen::Index> all_cases;
    for (const auto& end : ends) all_cases.insert(end.begin(), end.end());
    const std::vector<Eigen::Index> cases(all_cases.begin(), all_cases.end());
    const Eigen::MatrixXd means = leave_folds_out(model, inverse, ends).predict(model, model.points(cases, Eigen::all));
    const auto n = static_cast<double>(model.size());
    std::vector<Edge> edges;
    for (std::size_t e = 0; e < ends.size(); ++e) {
        Edge& edge = edges.emplace_back();
        edge.noise = std::sqrt(v);
        const auto count = static_cast<double>(ends[e].size());
        double missed = 0, all = 0;
        for (const Eigen::Index k : ends[e]) {
            const auto row = std::ranges::lower_bound(cases, k) - cases.begin();
            const double z = model.values(k), m = means(row, static_cast<Eigen::Index>(e));
            const RawMoments seen = closure(z, 0), expected = closure(m, v);
            for (std::size_t p = 0; p < seen.size(); ++p) edge.missed[p] += (seen[p] - expected[p]) / n;
            edge.predicted.push_back(m);
            missed += (z - m) * (z - m);
            all += z * z;
        }
        const double by_noise = v * (count + 3 * std::sqrt(2 * count) + 4);  // chi-squared, its largest of many
        const double beyond_noise = std::max(missed - by_noise, 0.0) / std::max(all, count);
        edge.unforeseen = std::min(std::sqrt(beyond_noise), 1.0);
    }
    return edges;
}

RawMoments closure(double m, double v) {
    const double m2 = m * m;
    return {m, m2 + v, m2 * m + 3 * m * v, m2 * m2 + 6 * m2 * v + 3 * v * v};
}

double dot(const RawMoments& gradient, const RawMoments& moments) {
    double sum = 0;
    for (std::size_t p = 0; p < gradient.size(); ++p) sum += gradient[p] * moments[p];
    return sum;
}

/// From the moments 1, 3, 15, 105 of e^2, e^4, e^6, e^8.
double normal_variance(const RawMoments& gradient, double m, double s) {
    const double m2 = m * m;
    const double c1 = s * (gradient[0] + 2 * gradient[1] * m + 3 * gradient[2] * m2 + 4 * gradient[3] * m2 * m);
    const double c2 = s * s * (gradient[1] + 3 * gradient[2] * m + 6 * gradient[3] * m2);
    const double c3 = s * s * s * (gradient[2] + 4 * gradient[3] * m);
    const double c4 = s * s * s * s * gradient[3];
    return c1 * c1 + 2 * c2 * c2 + 15 * c3 * c3 + 96 * c4 * c4 + 6 * c1 * c3 + 24 * c2 * c4;
}

BeyondCases::BeyondCases(std::span<const double> z, std::size_t sequences)
    : sorted_(z.begin(), z.end()), sequences_(sequences) {
    std::ranges::sort(sorted_);
    tails_ = tails_of(sorted_, sequences_);
}

void BeyondCases::add(const Kriging& model, const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& x,
                      const Eigen::MatrixXd& q, double v) {
    const auto orders = orders_of(x);
    far_out_ = far_out_ || reaches_far_out(x, orders, q);
    if (far_out_ && tails_.empty()) tails_ = tails_of(sorted_, sequences_, true);
    std::vector<std::vector<Eigen::Index>> ends;
    for (const std::size_t depth : {outermost, outermost / 2, 2 * outermost}) {
        const auto count =
            static_cast<std::ptrdiff_t>(std::min<std::size_t>(depth, static_cast<std::size_t>(x.rows())));
        for (const auto& order : orders) {
            ends.emplace_back(order.begin(), order.begin() + count);
            ends.emplace_back(order.end() - count, order.end());
        }
    }
    const auto edges = edges_of(model, inverse, ends, v);  // first those of depth `outermost`
    edges_.insert(edges_.end(), edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(2 * orders.size()));
    for (const Edge& edge : edges) unforeseen_ = std::max(unforeseen_, edge.unforeseen);
}

bool BeyondCases::endless() const {
    return std::ranges::any_of(tails_, &Tail::surely_endless);
}

bool BeyondCases::says_nothing() const {
    return !tails_.empty() && unforeseen_ > (endless() ? most_missed_without_end : most_missed);
}

double BeyondCases::half_width(const RawMoments& gradient) const {
    double by_edges = 0, by_tails = 0;
    const auto n = static_cast<double>(sorted_.size());
    for (const Edge& edge : edges_) {
        double by_noise = 0;
        for (const double m : edge.predicted) by_noise += normal_variance(gradient, m, edge.noise) / (n * n);
        by_edges += std::max(std::pow(dot(gradient, edge.missed), 2) - by_noise, 0.0) / 2;  // of two models
    }
    for (const Tail& tail : tails_)
        by_tails += tail.variance_of_mean([&](double z) { return dot(gradient, closure(z, 0)); });
    const double left = std::clamp(beyond_unforeseen * unforeseen_, far_out_ ? unforeseen_far_out : 0, 1.0);
    return std::hypot(std::sqrt(by_edges), left * tail_95 * std::sqrt(by_tails));
}

}  // namespace grainsweep::stats::response
