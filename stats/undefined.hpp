// What a statistic is where it has no value: too few values, or none that differ.
#pragma once

#include <limits>

namespace grainsweep::stats {

inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

}  // namespace grainsweep::stats
