#include "stats/group_test.hpp"

#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace grainsweep::stats {
namespace {

constexpr std::size_t permutations = 999, most_points = 1000;
constexpr double tie = 1e-9;  // of a standardised statistic, by another order of summation
constexpr std::uint64_t seed = 0x67726F757073ULL;

using Labels = std::vector<bool>;

std::vector<std::uint32_t> order_of(std::size_t count, std::uint64_t number) {
    return permutation(static_cast<std::uint32_t>(count), Generator(bits_at(seed, number, 0)));
}

/// Rows of the test, ascending, see the header.
std::vector<std::size_t> chosen_rows(const Labels& in_first) {
    const auto n = in_first.size();
    std::vector<std::size_t> rows(n);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (n <= most_points) return rows;
    const auto first = static_cast<std::size_t>(std::ranges::count(in_first, true));
    const bool rare = 2 * first <= n;
    const auto of_rare = std::min(std::min(first, n - first), most_points / 2);
    rows.clear();
    std::size_t left_rare = of_rare, left_others = most_points - of_rare;
    for (const auto i : order_of(n, permutations + 1)) {
        auto& left = in_first[i] == rare ? left_rare : left_others;
        if (left == 0) continue;
        --left;
        rows.push_back(i);
    }
    std::ranges::sort(rows);
    return rows;
}

/// Statistics of one assignment of the labels.
class Statistics {
public:
    explicit Statistics(std::vector<double> points, std::size_t d)
        : points_(std::move(points)), d_(d), n_(points_.size() / d), distance_(n_ * n_), sums_(n_, 0) {
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t k = 0; k < n_; ++k) {
                double square = 0;
                for (std::size_t j = 0; j < d_; ++j) square += std::pow(points_[i * d_ + j] - points_[k * d_ + j], 2);
                distance_[i * n_ + k] = std::sqrt(square);
                sums_[i] += distance_[i * n_ + k];
            }
        whole_ = std::accumulate(sums_.begin(), sums_.end(), 0.0);
        for (std::size_t j = 0; j < d_; ++j) {
            auto& order = orders_.emplace_back(n_);
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points_[i * d_ + j]; });
        }
    }

    [[nodiscard]] std::size_t points() const { return n_; }
    /// T_1 ... T_d, then T_0.
    [[nodiscard]] std::vector<double> of(const Labels& in_first) const {
        std::vector<double> all;
        for (std::size_t j = 0; j < d_; ++j) all.push_back(along(j, in_first));
        all.push_back(energy(in_first));
        return all;
    }

private:
    [[nodiscard]] double along(std::size_t j, const Labels& in_first) const {
        const auto first = static_cast<double>(std::ranges::count(in_first, true));
        const auto second = static_cast<double>(n_) - first;
        double difference = 0, sum = 0;
        for (std::size_t k = 0; k + 1 < n_; ++k) {
            const auto i = orders_[j][k];
            difference += in_first[i] ? 1 / first : -1 / second;
            sum += difference * difference * (points_[orders_[j][k + 1] * d_ + j] - points_[i * d_ + j]);
        }
        return 2 * sum;
    }
    [[nodiscard]] double energy(const Labels& in_first) const {
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < n_; ++i)
            if (in_first[i]) rows.push_back(i);
        double inside = 0, to_all = 0;
        for (const auto i : rows) {
            to_all += sums_[i];
            for (const auto k : rows) inside += distance_[i * n_ + k];
        }
        const auto first = static_cast<double>(rows.size()), second = static_cast<double>(n_) - first;
        const double across = to_all - inside, outside = whole_ - inside - 2 * across;
        return 2 * across / (first * second) - inside / (first * first) - outside / (second * second);
    }

    std::vector<double> points_;
    std::size_t d_, n_;
    std::vector<double> distance_, sums_;
    double whole_ = 0;
    std::vector<std::vector<std::size_t>> orders_;  ///< of the points along each feature
};

/// Values less their mean, divided by their standard deviation; 0 if all are equal.
std::vector<double> standardised(std::vector<double> values) {
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (const double x : values) squares += (x - mean) * (x - mean);
    const double sd = std::sqrt(squares / n);
    for (double& x : values) x = sd > 0 ? (x - mean) / sd : 0;
    return values;
}

}  // namespace

GroupTest compare_groups(Rows points, const std::vector<bool>& in_first, std::span<const double> low,
                         std::span<const double> high) {
    const std::size_t d = points.dimensions;
    if (d == 0 || points.values.size() != d * in_first.size() || low.size() != d || high.size() != d)
        throw std::invalid_argument("groups: one label is needed for each row, and a box");
    if (!std::ranges::all_of(points.values, [](double x) { return std::isfinite(x); }))
        throw std::invalid_argument("groups: a feature is not a finite number");
    GroupTest test{1, std::vector<double>(d, 1)};
    const auto first = std::ranges::count(in_first, true);
    if (first == 0 || first == std::ssize(in_first)) return test;
    std::vector<double> scaled;
    Labels observed;
    for (const auto i : chosen_rows(in_first)) {
        observed.push_back(in_first[i]);
        for (std::size_t j = 0; j < d; ++j)
            scaled.push_back(high[j] > low[j] ? (points.row(i)[j] - low[j]) / (high[j] - low[j]) : 0);
    }
    const Statistics statistics(std::move(scaled), d);
    std::vector<std::vector<double>> of_feature(d + 1);  // observed, then permuted
    for (std::size_t b = 0; b <= permutations; ++b) {
        Labels labels = observed;
        if (b > 0) {
            const auto order = order_of(observed.size(), b);
            for (std::size_t i = 0; i < order.size(); ++i) labels[i] = observed[order[i]];
        }
        const auto all = statistics.of(labels);
        for (std::size_t k = 0; k <= d; ++k) of_feature[k].push_back(all[k]);
    }
    std::vector<double> largest(permutations + 1, 0), own;
    for (auto& values : of_feature) {
        const auto z = standardised(std::move(values));
        own.push_back(z.front());
        for (std::size_t b = 0; b < z.size(); ++b) largest[b] = std::max(largest[b], z[b]);
    }
    const auto share_above = [&](double z) {
        return static_cast<double>(std::ranges::count_if(largest, [&](double x) { return x >= z - tie; })) /
               static_cast<double>(largest.size());
    };
    test.p_value = share_above(largest.front());
    for (std::size_t j = 0; j < d; ++j) test.p_of_feature[j] = share_above(own[j]);
    return test;
}

}  // namespace grainsweep::stats
