// Statistics SQLite does not have, for `grainsweep query`: SELECT median(mfr) FROM wu2020_lds.
//
// Definitions of Wu et al. 2020, eq. 18-21; all skip NULL.
//   sd(x)                sqrt(sum (x - mean)^2 / N)
//   median(x)            middle value, mean of the two middle ones for even N
//   pearson_skewness(x)  3 (mean - median) / sd
//   g1(x)                sum (x - mean)^3 / (N sd^3)
//   kurtosis(x)          sum (x - mean)^4 / (N sd^4): 3 for a normal distribution
// The last three are NULL where all values are equal.
#pragma once

#include "sweep/store/database.hpp"

namespace grainsweep::store {

void add_statistics(Connection& connection);

}  // namespace grainsweep::store
