// Values between those of a table.
#pragma once

#include <vector>

namespace grainsweep::tests {

/// Cubic through the four points nearest to `at`; x ascending, at least four of them.
[[nodiscard]] double cubic(const std::vector<double>& x, const std::vector<double>& y, double at);

}  // namespace grainsweep::tests
