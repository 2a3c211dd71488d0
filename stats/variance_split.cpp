#include "stats/variance_split.hpp"

#include "stats/confidence.hpp"
#include "stats/undefined.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace grainsweep::stats {
namespace {

constexpr std::size_t fewest_parts = 4;
constexpr std::size_t most_columns = 240;

/// A design point with its replicates taken together.
struct Point {
    std::size_t row = 0;  ///< where its coordinates stand
    double mean = 0, squares = 0;
    std::int64_t repeats = 0;
};

std::vector<Point> collapse(std::span<const std::int64_t> points, std::span<const double> values) {
    std::vector<Point> all;
    std::int64_t label = 0;
    for (std::size_t row = 0; row < values.size(); ++row) {
        if (!std::isfinite(values[row])) continue;
        if (all.empty() || points[row] != label) all.push_back({row, 0, 0, 0});
        label = points[row];
        Point& point = all.back();  // Welford's recurrence
        ++point.repeats;
        const double before = values[row] - point.mean;
        point.mean += before / static_cast<double>(point.repeats);
        point.squares += before * (values[row] - point.mean);
    }
    return all;
}

/// How finely the models resolve the response; the coarse ones show what finer ones may still lack.
enum class Resolution { fine, coarse };

/// Functions of one factor: columns of the additive model.
class FactorFunctions {
public:
    FactorFunctions(const SplitFactor& factor, std::span<const Point> points, Resolution resolution)
        : coordinates_(factor.coordinates) {
        std::vector<double> sorted;
        for (const auto& point : points) sorted.push_back(coordinates_[point.row]);
        std::ranges::sort(sorted);
        knots_ = sorted;
        knots_.erase(std::unique(knots_.begin(), knots_.end()), knots_.end());
        per_value_ = factor.pieces == 0 || knots_.size() <= factor.pieces + 1;
        if (!per_value_) {
            const std::size_t pieces =
                resolution == Resolution::fine ? factor.pieces : std::max<std::size_t>(1, factor.pieces / 2);
            for (std::size_t k = 0; k <= pieces; ++k) knots_[k] = sorted[k * (sorted.size() - 1) / pieces];
            knots_.resize(pieces + 1);
            knots_.erase(std::unique(knots_.begin(), knots_.end()), knots_.end());
        }
    }

    [[nodiscard]] std::size_t alone() const { return knots_.size() - 1; }
    void write_alone(std::size_t row, double* into) const {
        const double x = coordinates_[row];
        const auto upper = std::ranges::lower_bound(knots_, x);
        if (per_value_) {
            if (upper != knots_.begin()) into[upper - knots_.begin() - 1] = 1;
            return;
        }
        const auto k = std::clamp<std::ptrdiff_t>(upper - knots_.begin(), 1, std::ssize(knots_) - 1);
        const auto at = static_cast<std::size_t>(k);
        const double share = (x - knots_[at - 1]) / (knots_[at] - knots_[at - 1]);
        into[k - 1] = share;
        if (k > 1) into[k - 2] = 1 - share;
    }

private:
    std::span<const double> coordinates_;
    bool per_value_ = true;
    std::vector<double> knots_;  ///< or the distinct values
};

/// Columns of the model: the constant, then those of each factor.
class Columns {
public:
    Columns(std::span<const SplitFactor> factors, std::span<const Point> points, Resolution resolution) {
        for (const auto& factor : factors) {
            factors_.emplace_back(factor, points, resolution);
            count_ += factors_.back().alone();
        }
    }
    [[nodiscard]] std::size_t count() const { return count_; }

    [[nodiscard]] std::vector<double> of(std::size_t row) const {
        std::vector<double> columns(count_, 0);
        columns[0] = 1;
        std::size_t at = 1;
        for (const auto& factor : factors_) {
            factor.write_alone(row, columns.data() + at);
            at += factor.alone();
        }
        return columns;
    }

private:
    std::vector<FactorFunctions> factors_;
    std::size_t count_ = 1;
};

/// Everything the fits need of a set of points; sets add and subtract.
struct Sums {
    std::vector<double> gram;                         ///< X^T X, row-major, its lower half
    std::vector<double> products;                     ///< X^T y
    double squares = 0, points = 0, reciprocals = 0;  ///< of the means; of 1/r
    double error_squares = 0, error_freedom = 0;

    explicit Sums(std::size_t columns) : gram(columns * columns, 0), products(columns, 0) {}
    void add(const Point& point, std::span<const double> columns, double mean) {
        const std::size_t p = columns.size();
        for (std::size_t i = 0; i < p; ++i) {
            if (columns[i] == 0) continue;
            for (std::size_t j = 0; j <= i; ++j) gram[i * p + j] += columns[i] * columns[j];
            products[i] += mean * columns[i];
        }
        squares += mean * mean;
        points += 1;
        reciprocals += 1 / static_cast<double>(point.repeats);
        error_squares += point.squares;
        error_freedom += static_cast<double>(point.repeats - 1);
    }
    void add(const Sums& other, double sign) {
        for (std::size_t k = 0; k < gram.size(); ++k) gram[k] += sign * other.gram[k];
        for (std::size_t k = 0; k < products.size(); ++k) products[k] += sign * other.products[k];
        squares += sign * other.squares;
        points += sign * other.points;
        reciprocals += sign * other.reciprocals;
        error_squares += sign * other.error_squares;
        error_freedom += sign * other.error_freedom;
    }
};

struct Fit {
    double residual = undefined;  ///< sum of squares
    double coefficients = 0;      ///< that the points can tell apart
};

/// Least squares by the Cholesky factor of X^T X with the largest pivot first, as far as pivots are above 1e-10 of the
/// first: columns that others give are left out (Golub & Van Loan 2013, section 4.2.8).
Fit fit(const Sums& sums) {
    constexpr double least_pivot = 1e-10;
    const std::size_t p = sums.products.size();
    auto left = sums.gram;  // its lower half, what the columns taken so far leave of it
    auto right = sums.products;
    const auto entry = [&](std::size_t i, std::size_t j) -> double& {
        return left[std::max(i, j) * p + std::min(i, j)];
    };
    std::vector<std::size_t> rest(p);
    std::iota(rest.begin(), rest.end(), std::size_t{0});
    double explained = 0, first = 0, rank = 0;
    while (!rest.empty()) {
        const auto at = std::ranges::max_element(rest, {}, [&](std::size_t i) { return entry(i, i); });
        const std::size_t k = *at;
        const double pivot = entry(k, k);
        if (rank == 0) first = pivot;
        if (!(pivot > least_pivot * first)) break;
        rest.erase(at);
        ++rank;
        explained += right[k] * right[k] / pivot;
        for (const std::size_t i : rest) {
            const double share = entry(i, k) / pivot;
            if (share == 0) continue;
            right[i] -= share * right[k];
            for (const std::size_t j : rest)
                if (j <= i) entry(i, j) -= share * entry(j, k);
        }
    }
    // If the model reproduces the response exactly, the rest is rounding.
    const double residual = sums.squares - explained;
    return {residual > 1e-12 * sums.squares ? residual : 0, rank};
}

/// Variances by their parts; NaN where a part cannot be had.
struct SplitParts {
    double total = undefined, main = undefined, rest = undefined, interactions = undefined, scatter = undefined,
           coefficients = 0;
};

SplitParts parts_of(const Sums& sums, bool all_points) {
    SplitParts parts;
    const double n = sums.points;
    const Fit additive = fit(sums);
    parts.coefficients = additive.coefficients;
    if (all_points ? n <= additive.coefficients : n < 2 * additive.coefficients) return parts;
    const double mean = sums.products[0] / n;
    const double total_squares = sums.squares - n * mean * mean;
    if (!(total_squares > 0)) return parts;
    const bool repeated = sums.error_freedom > 0;
    const double scatter = repeated ? sums.error_squares / sums.error_freedom : 0;
    const double in_means = scatter * sums.reciprocals / n;  // variance that scatter gives the mean of a point
    const double residual = all_points ? additive.residual / n : additive.residual / (n - additive.coefficients);
    const double interactions = residual - in_means * (all_points ? (n - additive.coefficients) / n : 1);
    const double of_points =
        all_points ? total_squares / n - in_means * (n - 1) / n : total_squares / (n - 1) - in_means;
    parts.total = of_points + scatter;
    parts.main = of_points - interactions;
    parts.rest = interactions + scatter;
    if (repeated) {
        parts.scatter = scatter;
        parts.interactions = interactions;
    }
    return parts;
}

/// Computes half-widths of a lattice's shares for normal scatter. The sums of squares of main effects, of the other
/// means and of the replicates are independent multiples of (noncentral) chi-squared variables. Their variance is 2
/// (freedom) + 4 (noncentrality). To first order, a share is linear in the sums.
void normal_errors(VarianceSplit& split, const SplitParts& parts, const Sums& sums) {
    if (!(sums.error_freedom > 0)) return;
    const double n = sums.points, p = parts.coefficients;
    const double repeats = n / sums.reciprocals, in_means = parts.scatter / repeats;
    const auto variance_of = [&](double freedom, double part) {
        return in_means * (2 * freedom * in_means + 4 * n * std::max(0.0, part)) / (n * n);
    };
    using Three = std::array<double, 3>;
    const Three variances = {variance_of(p - 1, parts.main), variance_of(n - p, parts.interactions),
                             2 * parts.scatter * parts.scatter / sums.error_freedom};
    // How main effects, interactions and scatter change with the three; the estimates of the first two subtract
    // scatter.
    const Three main = {1, 0, -(p - 1) / (n * repeats)}, interactions = {0, 1, -(n - p) / (n * repeats)},
                scatter = {0, 0, 1};
    const auto half_width = [&](const SensitivityIndex& share, const Three& change) {
        double variance = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double of_total = main[k] + interactions[k] + scatter[k];
            variance += std::pow((change[k] - share.value * of_total) / parts.total, 2) * variances[k];
        }
        return student_factor(static_cast<std::int64_t>(sums.error_freedom)) * std::sqrt(variance);
    };
    split.main_effects.half_width = split.unexplained.half_width = half_width(split.main_effects, main);
    split.interactions.half_width = half_width(split.interactions, interactions);
    split.scatter.half_width = half_width(split.scatter, scatter);
}

}  // namespace

double PureError::half_width(double count) const {
    return student_factor(freedom) * std::sqrt(variance / count);
}

PureError pure_error(std::span<const std::int64_t> points, std::span<const double> values) {
    PureError error;
    double squares = 0;
    for (const auto& point : collapse(points, values)) {
        squares += point.squares;
        error.freedom += point.repeats - 1;
    }
    if (error.freedom > 0) error.variance = squares / static_cast<double>(error.freedom);
    return error;
}

namespace {

/// Shares of the whole sample, and of the sample without each of its groups.
struct Estimates {
    SplitParts parts;
    std::vector<SplitParts> leave_one_out;
    Sums sums;
};

Estimates split_estimate(const Columns& columns, std::span<const Point> points, std::span<const std::size_t> groups,
                         bool all_points) {
    double centre = 0;
    for (const auto& point : points) centre += point.mean / static_cast<double>(points.size());
    const std::size_t group_count = groups.empty() ? 1 : *std::ranges::max_element(groups) + 1;
    std::vector<Sums> by_group(group_count, Sums(columns.count()));
    for (const auto& point : points)
        by_group[groups.empty() ? 0 : groups[point.row]].add(point, columns.of(point.row), point.mean - centre);
    Estimates estimates{{}, {}, Sums(columns.count())};
    for (const auto& group : by_group) estimates.sums.add(group, 1);
    estimates.parts = parts_of(estimates.sums, all_points);
    if (all_points || groups.empty()) return estimates;
    for (const auto& group : by_group) {
        if (group.points == 0) continue;
        Sums others = estimates.sums;
        others.add(group, -1);
        estimates.leave_one_out.push_back(parts_of(others, all_points));
    }
    return estimates;
}

}  // namespace

VarianceSplit split_variance(std::span<const std::int64_t> points, std::span<const SplitFactor> factors,
                             std::span<const double> values, std::span<const std::size_t> groups, bool all_points) {
    assert(points.size() == values.size() && groups.size() == values.size());
    VarianceSplit split;
    split.pure = pure_error(points, values);
    const auto collapsed = collapse(points, values);
    split.points = std::ssize(collapsed);
    if (collapsed.empty()) return split;
    const Columns columns(factors, collapsed, Resolution::fine);
    if (columns.count() > most_columns) return split;
    const auto [parts, leave_one_out, sums] = split_estimate(columns, collapsed, groups, all_points);
    split.coefficients = static_cast<std::size_t>(parts.coefficients);
    const SplitParts coarse =
        all_points ? parts
                   : split_estimate(Columns(factors, collapsed, Resolution::coarse), collapsed, {}, false).parts;
    // Of interactions over points more even than random ones: the coefficients take nothing from their residuals.
    const double evenness =
        std::abs((std::isfinite(parts.interactions) ? parts.interactions : parts.rest) / parts.total) *
        parts.coefficients / static_cast<double>(collapsed.size());
    const auto share = [&](const auto& part, double allowance) {
        SensitivityIndex index{.value = part(parts) / parts.total};
        std::vector<double> others;
        for (const auto& one : leave_one_out) others.push_back(part(one) / one.total);
        if (others.size() >= fewest_parts)
            index.half_width =
                std::hypot(jackknife_half_width(others), part(coarse) / coarse.total - index.value) + allowance;
        return index;
    };
    split.main_effects = share([](const SplitParts& p) { return p.main; }, evenness);
    split.unexplained = share([](const SplitParts& p) { return p.rest; }, evenness);
    split.scatter = share([](const SplitParts& p) { return p.scatter; }, 0);
    split.interactions = share([](const SplitParts& p) { return p.interactions; }, evenness);
    if (all_points && std::isfinite(parts.total)) normal_errors(split, parts, sums);
    return split;
}

}  // namespace grainsweep::stats
