// Trend of a response with a factor.
#pragma once

#include "stats/sensitivity.hpp"

#include <span>

namespace grainsweep::stats {

/// Returns Spearman's rank correlation (1904): Pearson's correlation of the ranks; ties have their mean rank. It is +1
/// for a response that only rises, -1 for one that only falls. Pairs with a value that is not finite are left out.
/// `groups` labels the pairs 0 ... G-1 for the half-width (jackknife; NaN below four groups with pairs). NaN for fewer
/// than three pairs or if x or y is constant.
[[nodiscard]] SensitivityIndex rank_correlation(std::span<const double> x, std::span<const double> y,
                                                std::span<const std::size_t> groups);

/// Returns the share of the weighted variance of `means` that the best rising sequence explains: weighted isotonic
/// regression by pooling adjacent violators (Ayer et al. 1955). 1: they only rise. NaN if they do not vary.
[[nodiscard]] double rising_share(std::span<const double> means, std::span<const double> weights);

}  // namespace grainsweep::stats
