// The convergence rule `assisted`, for moments with a model of the response as control variate (assisted_moments.hpp).
//
// Checks have growing sizes, because each fits models. The first check is at the first multiple of `block` with at
// least 104 points and 8 (d + 1); with fewer points the coverage of the intervals is unknown. Each next check is at the
// first multiple of `block` that is a fifth larger. N points are checked at most 1 + log(N/104)/log(1.2) times.
//
// Each gate is measured as under `replicates` (convergence.hpp), by the half-width of its estimate: the assisted
// estimate if it was chosen at the check before, else the plain one. Plain g1 and kurtosis have no error while too few
// values carry them (convergence.hpp). The rule converges when every gate is below the tolerance at two consecutive
// checks. A check with a refused model does not pass, and its errors are NaN.
#pragma once

#include "stats/assisted_moments.hpp"
#include "stats/convergence.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Inputs of the models: the box of the features, and points that fill the factors' ranges as the design does.
struct ModelSpace {
    std::size_t dimensions = 0;
    std::vector<double> low, high;    ///< box of the features
    std::vector<double> integration;  ///< features of independent scramblings of one size, row-major
    std::size_t scramblings = 8;
};

class AssistedConvergence {
public:
    /// Throws std::invalid_argument for another rule than `assisted`, fewer than 4 sequences, no gate, a block below 1,
    /// a tolerance that is not positive, or a space without dimensions. Pearson's skewness as a gate throws, too: a
    /// median has no assisted estimate.
    AssistedConvergence(ConvergenceSettings settings, ModelSpace space);

    /// Returns the number of points of the next check.
    [[nodiscard]] std::int64_t next_check() const;
    [[nodiscard]] std::int64_t next_check(std::int64_t after) const;
    [[nodiscard]] std::size_t dimensions() const { return space_.dimensions; }
    /// Makes the next check. `points`, `values` (NaN: the case failed) and `features` are of every case below
    /// next_check() points, in the order of the design. Cost: up to 2 fits (4 at the first check) of at most 300 cases
    /// and models of at most 1,500 cases, plus a part that grows with the number of cases.
    void check(std::span<const std::int64_t> points, std::span<const double> values, std::span<const double> features);

    [[nodiscard]] std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
    /// Returns the first converged check, if any, at which the campaign may stop.
    [[nodiscard]] const Checkpoint* converged() const;

private:
    void take_estimates(Checkpoint& now, std::span<const std::int64_t> points, std::span<const double> values,
                        std::span<const double> features);

    ConvergenceSettings settings_;
    ModelSpace space_;
    std::vector<Checkpoint> checkpoints_;
    std::optional<AssistedMoments> before_;  ///< result of the last check, unless its model was refused
};

}  // namespace grainsweep::stats
