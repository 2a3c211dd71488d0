// Statistics that SQLite lacks, for `grainsweep query`: SELECT median(mfr) FROM wu2020_lds.
//
// All skip NULL; functions of two arguments skip a row with a NULL in either.
//   sd(x)                sqrt(sum (x - mean)^2 / N), and those of Wu et al. 2020, eq. 18-21, with it:
//   pearson_skewness(x)  3 (mean - median) / sd
//   g1(x)                sum (x - mean)^3 / (N sd^3)
//   kurtosis(x)          sum (x - mean)^4 / (N sd^4): 3 for a normal distribution
//   stddev_pop(x), var_pop(x)           divide by N: stddev_pop is sd
//   stddev(x), stddev_samp(x)           divide by N - 1, as in PostgreSQL, R and pandas; NULL for one value
//   variance(x), var_samp(x)            their squares
//   median(x)            middle value, mean of the two middle ones for even N
//   quantile(x, p)       p from 0 to 1, linear between the sorted values at (N - 1) p (R's type 7)
//   percentile(x, P)     quantile(x, P / 100)
//   quantile_error(x, p, sequence)   its 95 % half-width (stats/levels.hpp) over the values of `sequence`, 4 at least;
//                        where all are one sequence, over 8 batches of rows. NULL: too few values
//   above(x, t), below(x, t)            share of values beyond t
//   above_error(x, t, sequence), below_error(x, t, sequence)   their 95 % half-widths
//   corr(x, y)           Pearson's correlation; NULL where x or y does not vary
// covar_pop(x, y), covar_samp(x, y)   covariance, divided by N or by N - 1
// Skewnesses and kurtosis are NULL if all values are equal.
#pragma once

#include "sweep/store/database.hpp"

namespace grainsweep::store {

void add_statistics(Connection& connection);

}  // namespace grainsweep::store
