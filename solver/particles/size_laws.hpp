// Laws of sizes as tables. A law has no smallest size, and its finest particles would determine the time step. Sizes
// below its 0.5 % quantile and above its 99.5 % quantile are therefore counted in the outermost intervals of the table.
#pragma once

#include <string>

namespace grainsweep::particles {

/// Returns the text of a table (size_table.hpp) of a distribution with normal ln d: standard deviation `finer` below
/// the median and `coarser` above it. Shares are of volume, or of number. All arguments must be above 0.
[[nodiscard]] std::string lognormal_table(double median, double finer, double coarser, bool by_volume);
/// Returns the standard deviation of ln d of a half lognormal distribution with this median, if a tenth of all lies
/// beyond `tenth`.
[[nodiscard]] double half_spread(double median, double tenth);
/// Returns the text of a table by Rosin and Rammler (1933): the share exp(-(d/d63)^n) is coarser than d.
[[nodiscard]] std::string rosin_rammler_table(double d63, double n, bool by_volume);

}  // namespace grainsweep::particles
