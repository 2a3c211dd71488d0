// Sobol indices of the mean response from its model: total effects and interactions without a design made for them.
//
// A, B: two independent points; A_u, B_u: each with the coordinates u of the other.
//
//   V S_j       =  E[(f(A_j) - f(A)) (f(B) - f(B_j))]/2                                 first order
//   V (T_j-S_j) =  E[(f(A_j) - f(A) + f(B_j) - f(B))^2]/4                               interactions; T_j: total
//   V S_jk      =  E[(f(A_jk) - f(A_j) - f(A_k) + f(A)) (f(B_jk) - f(B_j) - f(B_k) + f(B))]/4   of two factors
//
// and of all noise factors N together, over the whole box, and with a control factor in one eighth of its range (at one
// of its levels): the variance by noise if the factor is set there.
//
//   V T_N       =  E[(f(A_N) - f(A))^2]/2
//
// f: the model's mean, so the scatter of runs is in no share. Each follows from the Hoeffding decomposition of f: the
// differences remove all parts without the factors (Liu & Owen 2006, J. Am. Stat. Assoc. 101, 712), the product of the
// differences at A and at B those that have others besides (Owen, Dick & Chen 2014, Inf. Inference 3, 59). Of an
// additive f, interactions are 0 at every single point, not only on average. Points: 8 independent scramblings of 1,024
// points of a Sobol sequence of twice the dimensions.
//
// Half-widths, in quadrature: jackknife over models each without one group of cases (hyperparameters kept,
// response/kriging.hpp); the bias that the jackknife estimates, (G - 1) (mean of these models - the whole one);
// Student t over the scramblings; the part that the model misses, leave-one-out error^2 less the share of scatter;
// and the effect of three coefficients that the residuals of n cases may hide, leave-one-out error^2 7.81/n. So a
// factor that the model leaves out is not 0 for sure.
#pragma once

#include "stats/response_model.hpp"
#include "stats/sensitivity.hpp"

#include <cstddef>
#include <functional>
#include <optional>
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

    /// Of a control factor, the part of its range where noise makes least.
    struct Calmest {
        std::size_t factor = 0;
        double from = 0, to = 1;  ///< in the factor's coordinate u
        SensitivityIndex left;    ///< share of the variance over the whole box
    };
    struct Noise {
        SensitivityIndex total;
        std::vector<Calmest> controls;  ///< the calmest first
    };
    std::optional<Noise> noise;  ///< none: no factor is noise, or all are
};

/// What is known of the factors besides.
struct FactorRoles {
    std::vector<bool> noise;          ///< empty: none is
    std::vector<std::size_t> levels;  ///< 0, or none given: continuous
};

/// `groups`: of every row the model was fitted from, e.g. its sequence, at least 2 different ones; empty: 8 consecutive
/// stretches. `features` may be empty: factors are the features, in the model's box. Throws std::invalid_argument where
/// sizes do not match or the model has cases added to it.
[[nodiscard]] ModelIndices model_indices(const ResponseModel& model, std::size_t factors,
                                         std::span<const std::size_t> groups = {}, const FeatureMap& features = {},
                                         const FactorRoles& roles = {});

}  // namespace grainsweep::stats
