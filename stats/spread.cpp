#include "stats/spread.hpp"

#include "stats/response_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::stats {

std::string reason_against_powers(std::span<const double> values, int power) {
    constexpr double largest_exponent = 300, smallest_exponent = -290;  // of a sum, as in moments.cpp
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (!(high > low)) return {};
    const double half = high / 2 - low / 2;  // the spread itself may overflow
    const double exponent = power * std::log10(half);
    if (half > 0 && exponent < largest_exponent && exponent > smallest_exponent) return {};
    return "the values from " + shown(low) + " to " + shown(high) + " spread so " + (half > 1 ? "far" : "little") +
           " that sums of their " + (power == 2 ? "squares" : "fourth powers") +
           " leave the range of double precision: choose another unit";
}

}  // namespace grainsweep::stats
