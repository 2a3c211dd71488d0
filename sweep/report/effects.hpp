// What a response looks like over its values and over each factor: binned, so that a picture of ten thousand cases
// is as light as one of a hundred.
#pragma once

#include "sweep/report/responses.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::report {

/// Counts in bins of equal width over [low, high]; the last bin includes high. All values equal: one bin.
struct Histogram {
    double low = 0, high = 0;
    std::vector<std::int64_t> counts;
};

/// Finite values in clamp(2 n^(1/3), 5, 40) bins (Rice's rule).
[[nodiscard]] Histogram histogram_of(std::span<const double> values);

/// The mean response near one value of a factor.
struct EffectBin {
    double at = 0;     ///< mean of the factor in the bin, or index of the level
    double mean = 0;   ///< of the response
    double error = 0;  ///< 95 % half-width as of independent points: on the large side for low-discrepancy ones
    std::int64_t count = 0;
};

/// Main effect of a factor: levels and up to 16 distinct values each make a bin, else 16 bins of equal count (fewer
/// where that would leave less than 8 cases in each). Rows without a response are left out.
[[nodiscard]] std::vector<EffectBin> main_effect(const FactorColumn& factor, std::span<const double> response);

}  // namespace grainsweep::report
