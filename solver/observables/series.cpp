#include "solver/observables/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace grainsweep::observables {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t blocks = 10;
constexpr std::size_t most = 4096;  // values; the time is quadratic in them
constexpr double least_independent = 4;
constexpr double least_of_few = 0.25;  // v/g_0 where blocks have one value: neighbours with a correlation of -0.6
constexpr double rounding = 1e-28;     // of a variance, in squares of the mean

/// Returns the 0.975 quantile of Student's distribution divided by that of the normal one: Fisher and Cornish's
/// expansion (Abramowitz and Stegun 26.7.5).
double student_over_normal(double degrees) {
    constexpr double z = 1.959964, z2 = z * z;
    const double nu = degrees;
    return 1 + (z2 + 1) / 4 / nu + (5 * z2 * z2 + 16 * z2 + 3) / 96 / (nu * nu) +
           (3 * z2 * z2 * z2 + 19 * z2 * z2 + 17 * z2 - 15) / 384 / (nu * nu * nu);
}

double autocovariance(std::span<const double> deviations, std::size_t lag) {
    double sum = 0;
    for (std::size_t k = 0; k + lag < deviations.size(); ++k) sum += deviations[k] * deviations[k + lag];
    return sum / static_cast<double>(deviations.size());
}

}  // namespace

double block_standard_error(std::span<const double> series, std::size_t blocks) {
    const std::size_t length = series.size() / blocks;
    if (length < 2 || blocks < 2) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> means(blocks, 0);
    double mean = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
        for (std::size_t k = 0; k < length; ++k) means[b] += series[b * length + k];
        means[b] /= static_cast<double>(length);
        mean += means[b] / static_cast<double>(blocks);
    }
    double squares = 0;
    for (const double m : means) squares += (m - mean) * (m - mean);
    const auto n = static_cast<double>(blocks);
    return std::sqrt(squares / (n * (n - 1)));
}

double standard_error_of_mean(std::span<const double> series) {
    if (series.size() > most) {  // means of neighbours have the same mean, and the same error of it
        std::vector<double> pairs;
        for (std::size_t k = 0; k + 1 < series.size(); k += 2) pairs.push_back((series[k] + series[k + 1]) / 2);
        return standard_error_of_mean(pairs);
    }
    const auto n = static_cast<double>(series.size());
    if (series.size() < blocks) return undefined;
    double mean = 0;
    for (const double x : series) mean += x;
    mean /= n;
    std::vector<double> deviations;
    for (const double x : series) deviations.push_back(x - mean);
    const double variance = autocovariance(deviations, 0);
    if (variance <= rounding * mean * mean) return 0;
    double sum = 0, last = std::numeric_limits<double>::infinity();
    std::size_t lags = 0;
    for (; 2 * lags + 1 < series.size() / 2; ++lags) {
        const double both = autocovariance(deviations, 2 * lags) + autocovariance(deviations, 2 * lags + 1);
        if (!(both > 0)) break;
        last = std::min(last, both);
        sum += last;
    }
    const double left = 1 - (4 * static_cast<double>(lags) - 1) / n;  // w = 2 lags - 1
    double of_one = std::max(0.0, 2 * sum - variance) / left;
    if (const double of_blocks = block_standard_error(series, blocks); std::isfinite(of_blocks))
        of_one = std::max(of_one, n * of_blocks * of_blocks);
    else
        of_one = std::max(of_one, least_of_few * variance);
    const double independent = std::min(n, n * variance / of_one);
    if (!(left > 0) || !(independent >= least_independent)) return undefined;
    return student_over_normal((independent - 1) / 2) * std::sqrt(of_one / n);
}

}  // namespace grainsweep::observables
