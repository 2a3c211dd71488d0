// Which way a response goes with a factor.
#pragma once

#include "stats/sensitivity.hpp"

#include <span>

namespace grainsweep::stats {

/// Spearman's rank correlation (1904): Pearson's correlation of the ranks, ties sharing their mean rank; +1 for a
/// response that only rises, -1 for one that only falls. Pairs with a value that is not finite are left out. `groups`
/// labels the pairs 0 ... G-1 for the half-width (jackknife; NaN below four groups with pairs). NaN for fewer than
/// three pairs or where one side is constant.
[[nodiscard]] SensitivityIndex rank_correlation(std::span<const double> x, std::span<const double> y,
                                                std::span<const std::size_t> groups);

/// How much of the variance of `means` (weighted) the best rising sequence explains: weighted isotonic regression by
/// pooling adjacent violators (Ayer et al. 1955). 1: they only rise. NaN where they do not vary.
[[nodiscard]] double rising_share(std::span<const double> means, std::span<const double> weights);

}  // namespace grainsweep::stats
