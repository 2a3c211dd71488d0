// Sobol indices of the mean response from its model: total effects and interactions without a design made for them.
//
//   S_j = 1 - E[(f(B) - f(A with x_j of B))^2]/2V       (first order; Jansen 1999, eq. 17)
//   T_j =     E[(f(A) - f(A with x_j of B))^2]/2V       (total; Jansen 1999, eq. 18)
//   S_jk = 1 - E[(f(B) - f(A with x_j, x_k of B))^2]/2V - S_j - S_k      (interaction of two factors)
//
// over 2,048 Sobol points (A, B) of twice the dimensions; f: the model's mean, so the scatter of runs is in no share.
// Half-widths: jackknife over models each without one group of cases (hyperparameters kept, response/kriging.hpp). A
// model is smoother than what it learns from: what it does not see, 1 - leave-one-out error^2 at worst, is missing.
#pragma once

#include "stats/response_model.hpp"
#include "stats/sensitivity.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Features of points of the factors' box [0, 1]^d; row-major in and out.
using FeatureMap = std::function<std::vector<double>(Rows factors)>;

struct ModelIndices {
    std::vector<SensitivityIndex> first;         ///< per factor
    std::vector<SensitivityIndex> total;         ///< per factor
    std::vector<SensitivityIndex> interactions;  ///< per factor, T_j - S_j
    std::vector<SensitivityIndex> pairs;         ///< S_jk for j < k, by rows: (0, 1), (0, 2), ..., (1, 2), ...
};

/// `groups`: of every row the model was fitted from, e.g. its sequence, at least 2 different ones; empty: 8 consecutive
/// stretches. `features` may be empty: factors are the features, in the model's box. Throws std::invalid_argument where
/// sizes do not match or the model has cases added to it.
[[nodiscard]] ModelIndices model_indices(const ResponseModel& model, std::size_t factors,
                                         std::span<const std::size_t> groups = {}, const FeatureMap& features = {});

}  // namespace grainsweep::stats
