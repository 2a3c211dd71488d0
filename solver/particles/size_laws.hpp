// Laws of sizes as tables. A law has no smallest size, and its finest particles would determine the time step. Sizes
// below its 0.5 % quantile are therefore counted in the first interval of the table. Sizes above the 99.5 % quantile by
// volume are counted in the last one: of a wide law by number, most of the mass lies above the 99.5 % quantile by
// number.
#pragma once

#include <string>

namespace grainsweep::particles {

/// Returns the text of a table (size_table.hpp) of a distribution with normal ln d: standard deviation `finer` below
/// the median and `coarser` above it. Shares are of all d^power: of number for 0, of surface for 2, of volume for 3.
/// All other arguments must be above 0. By number and surface the table is by volume, after Hatch and Choate (1929).
[[nodiscard]] std::string lognormal_table(double median, double finer, double coarser, int power);
/// Returns the standard deviation of ln d of a half lognormal distribution with this median, if a tenth of all lies
/// beyond `tenth`.
[[nodiscard]] double half_spread(double median, double tenth);
/// Returns the text of a table by Rosin and Rammler (1933): the share exp(-(d/d63)^n) of all d^power is coarser than d.
[[nodiscard]] std::string rosin_rammler_table(double d63, double n, int power);

}  // namespace grainsweep::particles
