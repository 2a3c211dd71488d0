// Whether the squares of a sample's deviations are numbers that double precision has.
#pragma once

#include <span>
#include <string>

namespace grainsweep::stats {

/// Explains why sums of the `power`-th powers of deviations overflow or vanish; empty where they do neither. Values
/// that are not finite are left out.
[[nodiscard]] std::string reason_against_powers(std::span<const double> values, int power);

}  // namespace grainsweep::stats
