// Shares of positive values in bins of equal width on a logarithmic axis, without a largest value to guess.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace grainsweep::observables {

/// (centre of bin, share of all values) of every bin that holds one, ascending. Bin k covers
/// [10^(k/n), 10^((k+1)/n)), n = per_decade, its centre is the geometric one; values below `floor`, which is
/// positive, count as `floor`. The shares add up to 1.
[[nodiscard]] std::vector<std::pair<double, double>> log_histogram(std::span<const double> values, int per_decade,
                                                                   double floor);

}  // namespace grainsweep::observables
