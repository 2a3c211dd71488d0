// Parts of the variance of a response: main effects, interactions, and scatter of single runs.
//
//   y(x, run) = m + sum_j f_j(x_j) + interactions(x) + e(run),    V[y] = V_main + V_int + sigma^2
//
// sigma^2, the pure error, comes from replicates: runs of one design point that differ by nothing but their random
// numbers (Draper & Smith 1998, section 2.1). V_main comes from a least-squares fit of an additive model (Hastie &
// Tibshirani 1990, section 5.2) to the means of the P points over their r replicates. The model has one mean per value
// of a factor with levels, and one continuous piecewise linear function of every other. Of the residual sum of squares
// RSS of a model with p coefficients
//
//   sampled points     E[RSS/(P - p)] = V_int + sigma^2 mean(1/r)
//   all points there   E[RSS/P]       = V_int + sigma^2 mean(1/r) (P - p)/P     (a lattice: V is over its own points)
//
// Replicates therefore separate interactions from scatter. Without replicates both are one share, `unexplained`: what
// the factors together would still explain, only a model of the response can tell (stats/model_indices.hpp). Products
// of functions of two factors cannot: of a deterministic response with a jump they called what they missed scatter.
//
// Half-widths of a sample are the sum in quadrature of two parts: the jackknife, and the change of a share if the model
// has half of the pieces, an estimate of the change by a finer one. Shares with interactions get share times p/P in
// addition, because on points more even than random ones the coefficients take less than p/P of RSS.
#pragma once

#include "stats/sensitivity.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace grainsweep::stats {

/// Scatter of single runs about the mean of their design point.
struct PureError {
    double variance = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no point has two values
    std::int64_t freedom = 0;                                    ///< degrees of freedom

    /// Returns the Student-t 95 % half-width of a mean of `count` runs that differ by their scatter only. NaN without
    /// replicates.
    [[nodiscard]] double half_width(double count) const;
};

/// Returns sum_i sum_k (y_ik - mean_i)^2 / sum_i (r_i - 1) over the points i with r_i >= 2 finite values. `points`
/// labels the rows; rows of one point must be adjacent.
[[nodiscard]] PureError pure_error(std::span<const std::int64_t> points, std::span<const double> values);

/// Factor of the models.
struct SplitFactor {
    std::span<const double> coordinates;  ///< one per row: position in the range, 0 to 1, or the index of a level
    /// Pieces of its piecewise linear function. One mean per value if 0, or if not fewer than its distinct values.
    std::size_t pieces = 0;
};

/// Shares of the variance of single runs. main_effects + unexplained = 1. Unbiased estimates can be slightly below 0.
/// NaN: cannot be estimated.
struct VarianceSplit {
    SensitivityIndex main_effects;
    SensitivityIndex unexplained;
    SensitivityIndex scatter;       ///< with replicates: sigma^2
    SensitivityIndex interactions;  ///< with replicates: of any order; interactions + scatter = unexplained
    PureError pure;
    std::int64_t points = 0;       ///< points with a value
    std::size_t coefficients = 0;  ///< of the additive model
};

/// Returns the split. Rows with a value that is not finite are left out. `points` as in pure_error(). `groups` labels
/// the rows 0 ... G-1 with the part of the sample that is left out for the half-widths (jackknife, NaN below four
/// parts); rows of one point have the same label. `all_points`: the points are the whole population, not a sample.
/// Half-widths then need replicates and assume normal scatter. All shares are NaN if there are fewer than two points
/// per coefficient (all_points: not more points than coefficients) or no variance.
[[nodiscard]] VarianceSplit split_variance(std::span<const std::int64_t> points, std::span<const SplitFactor> factors,
                                           std::span<const double> values, std::span<const std::size_t> groups,
                                           bool all_points);

}  // namespace grainsweep::stats
