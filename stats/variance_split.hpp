// What the variance of a response is made of: main effects, interactions, and the scatter of single runs.
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
// so that replicates separate interactions from scatter. Without, a second model adds products of two factors
// (Legendre polynomials up to a total degree of 3 to 10, as far as three points per coefficient allow). It shows how
// much of the rest is interactions of two factors. The remainder is scatter, higher interactions and the error of the
// products.
//
// Half-widths of a sample, in quadrature: jackknife, and the change of a share when the models have half of the pieces
// and two degrees less, for what finer models would find. Parts with interactions get their share times p/P on top: on
// points more even than random ones the coefficients take less from RSS than p/P of it.
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

    /// Student-t 95 % half-width of a mean of `count` runs that differ by their scatter only. NaN without replicates.
    [[nodiscard]] double half_width(double count) const;
};

/// sum_i sum_k (y_ik - mean_i)^2 / sum_i (r_i - 1) over the points i with r_i >= 2 finite values. `points` labels the
/// rows; rows of one point are neighbours.
[[nodiscard]] PureError pure_error(std::span<const std::int64_t> points, std::span<const double> values);

/// How one factor enters the models.
struct SplitFactor {
    std::span<const double> coordinates;  ///< one per row: position in the range, 0 to 1, or the index of a level
    bool ordered = true;                  ///< false: levels without an order, words
    /// Pieces of its piecewise linear function; 0, or no fewer than its distinct values: one mean per value.
    std::size_t pieces = 0;
};

/// Shares of the variance of single runs. main_effects + unexplained = 1. Estimates without bias can come out slightly
/// below 0. NaN: cannot be had.
struct VarianceSplit {
    SensitivityIndex main_effects;
    SensitivityIndex unexplained;
    SensitivityIndex scatter;       ///< with replicates: sigma^2
    SensitivityIndex interactions;  ///< with replicates: of any order; interactions + scatter = unexplained
    SensitivityIndex pairs;         ///< sampled points without replicates: interactions of two factors
    SensitivityIndex remainder;     ///< the same: scatter, higher interactions; pairs + remainder = unexplained
    PureError pure;
    std::int64_t points = 0;       ///< with a value
    std::size_t coefficients = 0;  ///< of the additive model
};

/// Rows with a value that is not finite are left out. `points` as in pure_error(). `groups` labels the rows 0 ... G-1,
/// rows of one point alike: parts of the sample that are left out in turn for the half-widths (jackknife, NaN below
/// four parts). `all_points`: the points are all there are, no sample. Half-widths then need replicates and assume
/// normal scatter. All shares are NaN where there are fewer than two points per coefficient (all_points: no
/// more points than coefficients) or no variance.
[[nodiscard]] VarianceSplit split_variance(std::span<const std::int64_t> points, std::span<const SplitFactor> factors,
                                           std::span<const double> values, std::span<const std::size_t> groups,
                                           bool all_points);

}  // namespace grainsweep::stats
