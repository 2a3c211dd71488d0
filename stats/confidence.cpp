#include "stats/confidence.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace grainsweep::stats {
namespace {

/// A power of two in which squares of the values neither overflow nor vanish; 1 where they do neither.
double unit_of(std::span<const double> values) {
    double largest = 0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    const bool sound = largest == 0 || !std::isfinite(largest) || (largest > 1e-140 && largest < 1e150);
    return sound ? 1 : std::exp2(std::ilogb(largest));
}

/// Sum of squared deviations from the mean, in squares of the unit; NaN where any value is.
double squared_deviations(std::span<const double> values, double unit) {
    double mean = 0;
    for (const double value : values) mean += value / unit / static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values) sum += (value / unit - mean) * (value / unit - mean);
    return sum;
}

}  // namespace

double student_factor(std::int64_t freedom) {
    if (freedom < 1) return std::numeric_limits<double>::quiet_NaN();
    return student_quantile(static_cast<double>(freedom), 0.975);
}

double student_quantile(double freedom, double probability) {
    return boost::math::quantile(boost::math::students_t(freedom), probability);
}

double student_probability(double freedom, double quantile) {
    return boost::math::cdf(boost::math::students_t(freedom), quantile);
}

double normal_quantile(double probability) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * probability);
}

double normal_cdf(double quantile) {
    return 0.5 * std::erfc(-quantile / std::numbers::sqrt2);
}

double student_half_width(std::span<const double> values) {
    if (values.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    const auto n = static_cast<double>(values.size());
    const double unit = unit_of(values);
    return unit *
           (student_factor(std::ssize(values) - 1) * std::sqrt(squared_deviations(values, unit) / (n * (n - 1))));
}

double largest_unseen_share(std::int64_t count) {
    return count < 1 ? 1 : -std::expm1(std::log(0.05) / static_cast<double>(count));
}

double jackknife_half_width(std::span<const double> leave_one_out) {
    if (leave_one_out.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    const auto n = static_cast<double>(leave_one_out.size());
    const double unit = unit_of(leave_one_out);
    return unit * (student_factor(std::ssize(leave_one_out) - 1) *
                   std::sqrt((n - 1) / n * squared_deviations(leave_one_out, unit)));
}

}  // namespace grainsweep::stats
