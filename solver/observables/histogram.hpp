// Shares of values in bins of equal width, without a largest value to guess.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace grainsweep::observables {

/// (centre of bin, share of all values) of every bin that holds one, ascending. Bin k covers
/// [k width, (k + 1) width); values >= 0, width > 0. The shares add up to 1.
[[nodiscard]] std::vector<std::pair<double, double>> histogram(std::span<const double> values, double width);

}  // namespace grainsweep::observables
