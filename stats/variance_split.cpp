#include "stats/variance_split.hpp"

#include "stats/confidence.hpp"
#include "stats/undefined.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace grainsweep::stats {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t fewest_parts = 4;
constexpr std::size_t most_columns = 240;
constexpr std::size_t least_degree = 3, most_degree = 10;  // of products

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

/// Legendre polynomial of degree 1 or more by its recurrence (Abramowitz & Stegun 1964, eq. 8.5.3).
double legendre(std::size_t degree, double x) {
    double before = 1, p = x;
    for (std::size_t l = 1; l < degree; ++l) {
        const auto n = static_cast<double>(l);
        before = std::exchange(p, ((2 * n + 1) * x * p - n * before) / (n + 1));
    }
    return p;
}

/// How finely the models resolve the response; the coarse ones show what finer ones may still lack.
enum class Resolution { fine, coarse };

/// The functions of one factor: columns of the additive model, and those that enter products.
class FactorFunctions {
public:
    FactorFunctions(const SplitFactor& factor, std::span<const Point> points, Resolution resolution)
        : coordinates_(factor.coordinates), ordered_(factor.ordered) {
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
    /// Functions that enter products of so many degrees in total.
    [[nodiscard]] std::size_t in_products(std::size_t degree) const {
        return ordered_ ? std::min(degree - 1, knots_.size() - 1) : knots_.size() - 1;
    }
    /// Degree of the k-th function that enters products; words have no degree to speak of.
    [[nodiscard]] std::size_t degree(std::size_t k) const { return ordered_ ? k + 1 : 1; }

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
    [[nodiscard]] double in_product(std::size_t row, std::size_t k) const {
        const double x = coordinates_[row];
        if (!ordered_) return x == knots_[k + 1] ? 1 : 0;
        return legendre(k + 1, 2 * x - 1);
    }

private:
    std::span<const double> coordinates_;
    bool ordered_;
    bool per_value_ = true;
    std::vector<double> knots_;  ///< or the distinct values
};

/// Columns of both models: the constant, the factors alone, the products.
class Columns {
public:
    Columns(std::span<const SplitFactor> factors, std::span<const Point> points, bool with_products,
            Resolution resolution) {
        for (const auto& factor : factors) {
            factors_.emplace_back(factor, points, resolution);
            additive_ += factors_.back().alone();
        }
        const std::size_t most = std::min(most_columns, points.size() / 3);
        std::size_t degree = with_products ? least_degree : 0;
        while (degree >= least_degree && degree < most_degree && additive_ + products(degree + 1).size() <= most)
            ++degree;
        if (with_products && additive_ + products(degree).size() <= most)
            products_ = products(resolution == Resolution::fine ? degree : degree - 2);
        all_ = additive_ + products_.size();
    }
    [[nodiscard]] std::size_t additive() const { return additive_; }
    [[nodiscard]] std::size_t all() const { return all_; }

    [[nodiscard]] VectorXd of(std::size_t row) const {
        VectorXd columns = VectorXd::Zero(static_cast<Index>(all_));
        columns[0] = 1;
        std::size_t at = 1;
        for (const auto& factor : factors_) {
            factor.write_alone(row, columns.data() + at);
            at += factor.alone();
        }
        for (const auto& [a, i, b, j] : products_)
            columns[static_cast<Index>(at++)] = factors_[a].in_product(row, i) * factors_[b].in_product(row, j);
        return columns;
    }

private:
    struct Product {
        std::size_t a, i, b, j;
    };

    /// Of two factors each, up to a degree in total.
    [[nodiscard]] std::vector<Product> products(std::size_t degree) const {
        std::vector<Product> all;
        for (std::size_t a = 0; a < factors_.size(); ++a)
            for (std::size_t b = a + 1; b < factors_.size(); ++b)
                for (std::size_t i = 0; i < factors_[a].in_products(degree); ++i)
                    for (std::size_t j = 0; j < factors_[b].in_products(degree); ++j)
                        if (factors_[a].degree(i) + factors_[b].degree(j) <= degree) all.push_back({a, i, b, j});
        return all;
    }

    std::vector<FactorFunctions> factors_;
    std::vector<Product> products_;
    std::size_t additive_ = 1, all_ = 1;
};

/// Everything the fits need of a set of points; sets add and subtract.
struct Sums {
    MatrixXd gram;
    VectorXd products;
    double squares = 0, points = 0, reciprocals = 0;  ///< of the means; of 1/r
    double error_squares = 0, error_freedom = 0;

    explicit Sums(std::size_t columns)
        : gram(MatrixXd::Zero(static_cast<Index>(columns), static_cast<Index>(columns))),
          products(VectorXd::Zero(static_cast<Index>(columns))) {}
    void add(const Point& point, const VectorXd& columns, double mean) {
        gram.selfadjointView<Eigen::Lower>().rankUpdate(columns);
        products += mean * columns;
        squares += mean * mean;
        points += 1;
        reciprocals += 1 / static_cast<double>(point.repeats);
        error_squares += point.squares;
        error_freedom += static_cast<double>(point.repeats - 1);
    }
    void add(const Sums& other, double sign) {
        gram += sign * other.gram;
        products += sign * other.products;
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

Fit fit(const Sums& sums, std::size_t columns) {
    const auto p = static_cast<Index>(columns);
    const MatrixXd gram = sums.gram.topLeftCorner(p, p).selfadjointView<Eigen::Lower>();
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
    solver.setThreshold(1e-10);
    solver.compute(gram);
    const VectorXd coefficients = solver.solve(sums.products.head(p));
    const double explained = coefficients.dot(sums.products.head(p));
    // What is left of a response that the model meets exactly is rounding.
    const double left = sums.squares - explained;
    return {left > 1e-12 * sums.squares ? left : 0, static_cast<double>(solver.rank())};
}

/// Variances by their parts; NaN where a part cannot be had.
struct SplitParts {
    double total = undefined, main = undefined, rest = undefined, interactions = undefined, scatter = undefined,
           pairs = undefined, coefficients = 0;
};

SplitParts parts_of(const Sums& sums, const Columns& columns, bool all_points) {
    SplitParts parts;
    const double n = sums.points;
    const Fit additive = fit(sums, columns.additive());
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
    } else if (columns.all() > columns.additive()) {
        const Fit full = fit(sums, columns.all());
        if (n >= 2 * full.coefficients) parts.pairs = residual - full.residual / (n - full.coefficients);
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
    std::vector<Sums> by_group(group_count, Sums(columns.all()));
    for (const auto& point : points)
        by_group[groups.empty() ? 0 : groups[point.row]].add(point, columns.of(point.row), point.mean - centre);
    Estimates estimates{{}, {}, Sums(columns.all())};
    for (const auto& group : by_group) estimates.sums.add(group, 1);
    estimates.parts = parts_of(estimates.sums, columns, all_points);
    if (all_points || groups.empty()) return estimates;
    for (const auto& group : by_group) {
        if (group.points == 0) continue;
        Sums others = estimates.sums;
        others.add(group, -1);
        estimates.leave_one_out.push_back(parts_of(others, columns, all_points));
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
    const bool with_products = !all_points && split.pure.freedom == 0;
    const Columns columns(factors, collapsed, with_products, Resolution::fine);
    if (columns.additive() > most_columns) return split;
    const auto [parts, leave_one_out, sums] = split_estimate(columns, collapsed, groups, all_points);
    split.coefficients = static_cast<std::size_t>(parts.coefficients);
    SplitParts coarse = all_points ? parts
                                   : split_estimate(Columns(factors, collapsed, with_products, Resolution::coarse),
                                                    collapsed, {}, false)
                                         .parts;
    if (std::isfinite(parts.pairs) && !std::isfinite(coarse.pairs)) coarse.pairs = 0;
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
    split.pairs = share([](const SplitParts& p) { return p.pairs; }, evenness);
    split.remainder = share([](const SplitParts& p) { return p.rest - p.pairs; }, 0);
    if (all_points && std::isfinite(parts.total)) normal_errors(split, parts, sums);
    return split;
}

}  // namespace grainsweep::stats
