// Series in time: from when on they rest, and how well their mean is known although neighbours are correlated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace grainsweep::stats {

/// First index from which the series stays within `band` (absolute, >= 0) of its last value; the size of the
/// series where even the last is not finite, or the series is empty.
[[nodiscard]] std::size_t settled_from(std::span<const double> series, double band);

/// Mean of a correlated series with its standard error.
struct BlockedMean {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double standard_error = std::numeric_limits<double>::quiet_NaN();
    std::size_t block_length = 0;  ///< samples per block at which blocks are as good as independent
    double effective_samples = 0;  ///< independent samples that would give the same standard error
    bool plateau = false;          ///< false: the series is too short for its correlation; the error is a lower bound
};

/// Blocking (Flyvbjerg & Petersen 1989, J. Chem. Phys. 91, 461): neighbours are averaged in pairs again and
/// again; the error of the mean from the averages grows until blocks are longer than the correlation. The
/// level taken is the first whose block length B obeys B^3 > 2 n (e_B/e_1)^4 (Wolff 2004; Lee et al. 2011, Phys.
/// Rev. B 83, 245130), which balances bias and noise. Samples that do not fill a pair at a level are left out of
/// the error (never of the mean). All samples must be finite; fewer than 2 give NaN.
[[nodiscard]] BlockedMean blocked_mean(std::span<const double> series);

}  // namespace grainsweep::stats
