// The rule `assisted`: when enough points have been asked for moments that take a model of the response as control
// variate (assisted_moments.hpp).
//
// Checks are at growing sizes, because each fits models. The first is the first multiple of `block` with at least 104
// points and 8 (d + 1); fewer points are not known to give intervals that hold. Each next one is the first multiple of
// `block` that is a fifth larger. N points are checked at most 1 + log(N/104)/log(1.2) times. Each gate is measured as
// under `replicates` (convergence.hpp), by the half-width of the estimate its statistic takes: the assisted one where
// that was chosen at the check before, else the plain one. Its g1 and kurtosis have no error while too few values carry
// them (convergence.hpp). It converges where every gate is below the tolerance at two consecutive
// checks. A model that is refused decides nothing: that check does not pass, and its errors are NaN.
#pragma once

#include "stats/assisted_moments.hpp"
#include "stats/convergence.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// What the models see of a case: features, and points that fill the factors' ranges as the design does.
struct ModelSpace {
    std::size_t dimensions = 0;
    std::vector<double> low, high;    ///< box of the features
    std::vector<double> integration;  ///< features of independent scramblings of one size, row-major
    std::size_t scramblings = 8;
};

class AssistedConvergence {
public:
    /// Throws std::invalid_argument for another rule than `assisted`, fewer than 4 sequences, no gate, a block below 1,
    /// a tolerance that is not positive, or a space without dimensions. Also for Pearson's skewness as a gate: a median
    /// has no such estimate.
    AssistedConvergence(ConvergenceSettings settings, ModelSpace space);

    /// Points of the next check, after one of that number of points.
    [[nodiscard]] std::int64_t next_check() const;
    [[nodiscard]] std::int64_t next_check(std::int64_t after) const;
    [[nodiscard]] std::size_t dimensions() const { return space_.dimensions; }
    /// Makes it: `points`, `values` (NaN: the case failed) and features of every case below next_check() points, in the
    /// order of the design. It takes the time of up to 2 (at the first check 4) fits of at most 300 cases and of models
    /// of at most 1,500; beyond that it grows with the number of cases.
    void check(std::span<const std::int64_t> points, std::span<const double> values, std::span<const double> features);

    [[nodiscard]] std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
    /// The first converged check, if any: where the campaign may stop.
    [[nodiscard]] const Checkpoint* converged() const;

private:
    void take_estimates(Checkpoint& now, std::span<const std::int64_t> points, std::span<const double> values,
                        std::span<const double> features);

    ConvergenceSettings settings_;
    ModelSpace space_;
    std::vector<Checkpoint> checkpoints_;
    std::optional<AssistedMoments> before_;  ///< of the last check, unless its model was refused
};

}  // namespace grainsweep::stats
