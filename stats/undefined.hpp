// Value of an undefined statistic: too few values, or all are equal.
#pragma once

#include <limits>

namespace grainsweep::stats {

inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

}  // namespace grainsweep::stats
