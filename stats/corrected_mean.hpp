// Mean of an expensive response over a box, from many values of a cheap one and some pairs.
//
//   T = S + D,   S = mean over all points of g(x, c),   D = mean over the pairs of e - g(x, c)
//
// with the cheap value c and the expensive value e at the point x. T has no bias for any predictor g, because g is
// fitted without the sequence that it predicts (cross-fitting as in stats/assisted_moments.hpp). Predictors:
//   difference  g = c                        two-level Monte Carlo (Giles 2015, Acta Numerica 24, 259)
//   slope       g = b0 + b c                 control variate (Lavenberg & Welch 1981, Management Science 27, 322)
//   factors     g = b0 + b c + sum_j b_j x_j regression, from four pairs a coefficient on
//   squares     the same + sum_j a_j x_j^2
//   model       g = c + GP(x)                the response model of the difference, from 24 to 500 pairs
// The predictor with the smallest rms residual on left-out sequences, times its Student factor, is used. If single runs
// scatter strongly, b tends to 0 and T to the mean of the expensive values alone.
//
// 95 % half-widths:
//   statistics  of S: Student's t over the R sequences, which know that the points are spread evenly
//   numerics    of D, from (a) Student's t over the sequences and (b) t sd/sqrt(n) of the residuals: the larger one
//               below 200 pairs, then their root mean square
//   together    sqrt(statistics^2 + numerics^2), or the root mean square of it and of Student's t over the T of the
//               sequences where that is larger
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace grainsweep::stats {

enum class PairPredictor { none, difference, slope, factors, squares, model };

[[nodiscard]] std::string_view to_string(PairPredictor predictor);

/// Values by point; NaN: no value. Point p belongs to sequence p mod `sequences`. `expensive` contains the first points
/// only; empty: T is the mean of the cheap response. `points`: factors of each point, 0 to 1; empty: unknown.
struct PairedValues {
    std::span<const double> cheap, expensive;
    std::size_t sequences = 8;
    Rows points = {};
};

struct CorrectedMean {
    double value = std::numeric_limits<double>::quiet_NaN();       ///< T
    double numerics = std::numeric_limits<double>::quiet_NaN();    ///< 0 without `expensive`
    double statistics = std::numeric_limits<double>::quiet_NaN();  ///< NaN: fewer than two sequences, or equal ones
    double together = std::numeric_limits<double>::quiet_NaN();
    /// Half-width of S without the linear trend over the factors, as if the points integrated the trend exactly; many
    /// evenly spread points approach this.
    double scatter = std::numeric_limits<double>::quiet_NaN();
    PairPredictor by = PairPredictor::none;
};

/// Returns T. NaN: undefined. While all pairs are equal, `numerics` is unknown.
[[nodiscard]] CorrectedMean corrected_mean(const PairedValues& values);

}  // namespace grainsweep::stats
