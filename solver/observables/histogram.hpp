// Shares of positive values in bins of equal width on a logarithmic axis without an upper limit.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace grainsweep::observables {

/// Returns (centre of bin, share of all values) of every non-empty bin, ascending. Bin k covers [10^(k/n),
/// 10^((k+1)/n)), n = per_decade; its centre is the geometric mean. Values below `floor` > 0 count as `floor`. The
/// shares add to 1.
[[nodiscard]] std::vector<std::pair<double, double>> log_histogram(std::span<const double> values, int per_decade,
                                                                   double floor);

}  // namespace grainsweep::observables
