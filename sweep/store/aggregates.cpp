#include "sweep/store/aggregates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grainsweep::store {

namespace {

double mean(std::span<const double> x) {
    double sum = 0;
    for (const double value : x) sum += value;
    const double first = sum / static_cast<double>(x.size());
    double rest = 0;  // second pass: what rounding left over
    for (const double value : x) rest += value - first;
    return first + rest / static_cast<double>(x.size());
}

double central_moment(std::span<const double> x, int order) {
    const double m = mean(x);
    double sum = 0;
    for (const double value : x) {
        const double d = value - m;
        sum += order == 2 ? d * d : (order == 3 ? d * d * d : d * d * d * d);
    }
    return sum / static_cast<double>(x.size());
}

std::optional<double> sd(std::span<double> x) {
    return std::sqrt(central_moment(x, 2));
}

/// Asked of the values: the rounded second moment of equal values need not be zero.
bool all_equal(std::span<const double> x) {
    return std::ranges::all_of(x, [&](double v) { return v == x.front(); });
}

std::optional<double> median(std::span<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    if (x.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(x.begin(), middle));
}

std::optional<double> pearson_skewness(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    const double m = mean(x);
    const double s = *sd(x);
    return 3 * (m - *median(x)) / s;
}

std::optional<double> g1(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    const double variance = central_moment(x, 2);
    return central_moment(x, 3) / (variance * std::sqrt(variance));
}

std::optional<double> kurtosis(std::span<double> x) {
    if (all_equal(x)) return std::nullopt;
    const double variance = central_moment(x, 2);
    return central_moment(x, 4) / (variance * variance);
}

}  // namespace

void add_statistics(Connection& connection) {
    connection.add_aggregate("sd", sd);
    connection.add_aggregate("median", median);
    connection.add_aggregate("pearson_skewness", pearson_skewness);
    connection.add_aggregate("g1", g1);
    connection.add_aggregate("kurtosis", kurtosis);
}

}  // namespace grainsweep::store
