#include "sweep/store/aggregates.hpp"

#include "stats/convergence_rule.hpp"
#include "stats/levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace grainsweep::store {

namespace {

double mean(std::span<const double> x) {
    double sum = 0;
    for (const double value : x) sum += value;
    const double first = sum / static_cast<double>(x.size());
    double rest = 0;  // second pass: rounding error of the first
    for (const double value : x) rest += value - first;
    return first + rest / static_cast<double>(x.size());
}

/// Divides values by a power of two near the largest of them. Returns its exponent.
int scale(std::vector<double>& x) {
    double largest = 0;
    for (const double value : x) largest = std::max(largest, std::abs(value));
    const int exponent = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
    for (double& value : x) value = std::ldexp(value, -exponent);
    return exponent;
}

/// Deviations from the mean, divided by 2^exponent, in which their powers neither overflow nor vanish.
struct Deviations {
    std::vector<double> values;
    int exponent = 0;

    explicit Deviations(std::span<const double> x) : values(x.begin(), x.end()), exponent(scale(values)) {
        const double m = mean(values);
        for (double& value : values) value -= m;
        exponent += scale(values);
    }
    [[nodiscard]] double moment(int order) const {
        double sum = 0;
        for (const double d : values) sum += order == 2 ? d * d : (order == 3 ? d * d * d : d * d * d * d);
        return sum / static_cast<double>(values.size());
    }
};

/// The number times 2^exponent; none where double precision does not reach so far.
std::optional<double> in_range(double number, int exponent) {
    const double value = std::ldexp(number, exponent);
    return std::isfinite(value) && (value != 0 || number == 0) ? std::optional(value) : std::nullopt;
}

std::optional<double> sd(std::span<double> x) {
    const Deviations d(x);
    return in_range(std::sqrt(d.moment(2)), d.exponent);
}

/// Asked of the values: the rounded second moment of equal values need not be zero.
bool all_equal(std::span<const double> x) {
    return std::ranges::all_of(x, [&](double v) { return v == x.front(); });
}

std::optional<double> median(std::span<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    if (x.size() % 2 == 1) return *middle;
    return std::midpoint(*middle, *std::max_element(x.begin(), middle));
}

std::optional<double> pearson_skewness(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    Deviations d(x);
    const double s = std::sqrt(d.moment(2));
    return -3 * *median(d.values) / s;
}

std::optional<double> g1(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    const Deviations d(x);
    const double variance = d.moment(2);
    return d.moment(3) / (variance * std::sqrt(variance));
}

std::optional<double> kurtosis(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    const Deviations d(x);
    const double variance = d.moment(2);
    return d.moment(4) / (variance * variance);
}

std::optional<double> var_pop(std::span<double> x) {
    const Deviations d(x);
    return in_range(d.moment(2), 2 * d.exponent);
}

std::optional<double> var_samp(std::span<double> x) {
    if (x.size() < 2) return std::nullopt;
    const auto n = static_cast<double>(x.size());
    const Deviations d(x);
    return in_range(d.moment(2) * (n / (n - 1)), 2 * d.exponent);
}

std::optional<double> stddev_samp(std::span<double> x) {
    if (x.size() < 2) return std::nullopt;
    const auto n = static_cast<double>(x.size());
    const Deviations d(x);
    return in_range(std::sqrt(d.moment(2) * (n / (n - 1))), d.exponent);
}

/// Sampled of two numbers as two columns.
std::array<std::vector<double>, 2> transposed(std::span<const double> rows) {
    std::array<std::vector<double>, 2> columns;
    for (std::size_t k = 0; k + 1 < rows.size(); k += 2) {
        columns[0].push_back(rows[k]);
        columns[1].push_back(rows[k + 1]);
    }
    return columns;
}

/// The p-quantile; `share` is the same for every row.
std::optional<double> quantile_of(std::span<const double> rows, double whole, const char* rule) {
    auto [x, shares] = transposed(rows);
    const double p = shares.front() / whole;
    if (!(p >= 0 && p <= 1) || !all_equal(shares)) throw std::invalid_argument(rule);
    std::ranges::sort(x);
    return stats::quantile_of_sorted(x, p);
}

/// Sampled of value, level and sequence as a sample; the level is the same in every row.
std::optional<double> level_error(std::span<const double> rows, const char* rule, const auto& level_at) {
    std::map<double, std::vector<double>> by_sequence;
    std::vector<double> values, sorted, levels;
    for (std::size_t k = 0; k + 2 < rows.size(); k += 3) {
        values.push_back(rows[k]);
        levels.push_back(rows[k + 1]);
        by_sequence[rows[k + 2]].push_back(rows[k]);
    }
    if (!all_equal(levels)) throw std::invalid_argument(rule);
    const stats::Level level = level_at(levels.front());
    sorted = values;
    std::ranges::sort(sorted);
    stats::GroupedSample sample{.sorted = sorted, .groups = {}, .independent = by_sequence.size() > 1};
    for (const auto& [number, of_sequence] : by_sequence) sample.groups.emplace_back(of_sequence);
    if (!sample.independent) sample.groups = stats::batches_of(values);
    if (sample.groups.size() < stats::fewest_sequences) return std::nullopt;
    const double error = stats::level_of(level, sample).error;
    return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

std::optional<double> quantile_error(std::span<double> rows) {
    constexpr auto rule = "quantile_error(x, p, sequence): p is one number between 0 and 1";
    return level_error(rows, rule, [&](double p) {
        if (!(p > 0 && p < 1)) throw std::invalid_argument(rule);
        return stats::Quantile{p};
    });
}

std::optional<double> share_beyond(std::span<const double> rows, const char* rule, bool above) {
    const auto [x, thresholds] = transposed(rows);
    if (!all_equal(thresholds)) throw std::invalid_argument(rule);
    const double t = thresholds.front();
    const auto beyond = std::ranges::count_if(x, [&](double value) { return above ? value > t : value < t; });
    return static_cast<double>(beyond) / static_cast<double>(x.size());
}

std::optional<double> exceedance_error(std::span<const double> rows, const char* rule, bool above) {
    return level_error(rows, rule, [&](double t) { return stats::Exceedance{t, above}; });
}

double product_moment(const Deviations& x, const Deviations& y) {
    double sum = 0;
    for (std::size_t k = 0; k < x.values.size(); ++k) sum += x.values[k] * y.values[k];
    return sum / static_cast<double>(x.values.size());
}

std::optional<double> covariance(std::span<const double> rows, double factor) {
    const auto [first, second] = transposed(rows);
    const Deviations x(first), y(second);
    return in_range(product_moment(x, y) * factor, x.exponent + y.exponent);
}

std::optional<double> covar_samp(std::span<double> rows) {
    const auto n = static_cast<double>(rows.size() / 2);
    return n < 2 ? std::nullopt : covariance(rows, n / (n - 1));
}

std::optional<double> corr(std::span<double> rows) {
    const auto [first, second] = transposed(rows);
    if (all_equal(first) || all_equal(second)) return std::nullopt;
    const Deviations x(first), y(second);
    return std::clamp(product_moment(x, y) / (std::sqrt(x.moment(2)) * std::sqrt(y.moment(2))), -1.0, 1.0);
}

using Sampled = std::span<double>;

struct Aggregate {
    const char* name;
    int arguments;
    std::optional<double> (*statistic)(Sampled rows);
};

constexpr std::array aggregates = {
    Aggregate{"sd", 1, sd},
    Aggregate{"stddev_pop", 1, sd},
    Aggregate{"stddev", 1, stddev_samp},
    Aggregate{"stddev_samp", 1, stddev_samp},
    Aggregate{"var_pop", 1, var_pop},
    Aggregate{"variance", 1, var_samp},
    Aggregate{"var_samp", 1, var_samp},
    Aggregate{"median", 1, median},
    Aggregate{"quantile", 2,
              [](Sampled x) { return quantile_of(x, 1, "quantile(x, p): p is one number from 0 to 1"); }},
    Aggregate{"percentile", 2,
              [](Sampled x) { return quantile_of(x, 100, "percentile(x, P): P is one number from 0 to 100"); }},
    Aggregate{"quantile_error", 3, quantile_error},
    Aggregate{"above", 2, [](Sampled x) { return share_beyond(x, "above(x, t): t is one number", true); }},
    Aggregate{"below", 2, [](Sampled x) { return share_beyond(x, "below(x, t): t is one number", false); }},
    Aggregate{"above_error", 3,
              [](Sampled x) { return exceedance_error(x, "above_error(x, t, sequence): t is one number", true); }},
    Aggregate{"below_error", 3,
              [](Sampled x) { return exceedance_error(x, "below_error(x, t, sequence): t is one number", false); }},
    Aggregate{"corr", 2, corr},
    Aggregate{"covar_pop", 2, [](Sampled x) { return covariance(x, 1); }},
    Aggregate{"covar_samp", 2, covar_samp},
    Aggregate{"pearson_skewness", 1, pearson_skewness},
    Aggregate{"g1", 1, g1},
    Aggregate{"kurtosis", 1, kurtosis},
};

}  // namespace

void add_statistics(Connection& connection) {
    for (const auto& [name, arguments, statistic] : aggregates) connection.add_aggregate(name, arguments, statistic);
}

}  // namespace grainsweep::store
