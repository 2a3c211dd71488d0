// Standard errors of means of correlated series, of equally spaced values.
#pragma once

#include <cstddef>
#include <span>

namespace grainsweep::observables {

/// Returns the standard error of the mean of a correlated series, from the means of `blocks` consecutive blocks of
/// equal length (batch means). NaN if a block has fewer than two values. The remainder after the last full block is
/// left out.
[[nodiscard]] double block_standard_error(std::span<const double> series, std::size_t blocks);

/// Returns a standard error s of the mean of a correlated series of n values, so that 1.96 s is meant as half of a 95 %
/// interval. Measured over 200 series, with correlations of neighbours up to 0.8: at least 0.91
/// (tests/physics/series_error.cpp).
///
///     s^2 = (t/1.96)^2 v/n,   v = (2 sum_j G_j - g_0)/(1 - (2 w + 1)/n),   G_j = g_2j + g_2j+1
///
/// g_k: autocovariance at lag k. The sum ends before the first G_j <= 0, at lag w, and no G_j counts more than the one
/// before it: Geyer (1992), Statistical Science 7, 473, initial monotone sequence. The denominator corrects for the
/// mean, which comes from the same values. t: quantile of Student's distribution with half as many degrees of freedom
/// as there are independent values, n g_0/v. v is at least that of the means of ten blocks; of fewer than twenty values
/// at least g_0/4, because chance makes the sum 0 or less. NaN for fewer than ten values, or fewer than four
/// independent ones.
[[nodiscard]] double standard_error_of_mean(std::span<const double> series);

}  // namespace grainsweep::observables
