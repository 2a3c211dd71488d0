// Check that powers of a sample's deviations are within the range of double precision.
#pragma once

#include <span>
#include <string>

namespace grainsweep::stats {

/// Returns why sums of the `power`-th powers of deviations overflow or vanish; empty if they do neither. Values that
/// are not finite are left out.
[[nodiscard]] std::string reason_against_powers(std::span<const double> values, int power);

}  // namespace grainsweep::stats
