// Sobol indices of the mean response from its model. Total effects and interactions need no special design.
//
// A, B: two independent points; A_u, B_u: each with the coordinates u of the other.
//
//   V S_j       =  E[(f(A_j) - f(A)) (f(B) - f(B_j))]/2                                 first order
//   V (T_j-S_j) =  E[(f(A_j) - f(A) + f(B_j) - f(B))^2]/4                               interactions; T_j: total
//   V S_jk      =  E[(f(A_jk) - f(A_j) - f(A_k) + f(A)) (f(B_jk) - f(B_j) - f(B_k) + f(B))]/4   of two factors
//
// The variance from all noise factors N together is computed for the whole box, and with a control factor set in one
// eighth of its range, or at one of its levels:
//
//   V T_N       =  E[(f(A_N) - f(A))^2]/2
//
// If factors are columns of one sample, they depend on each other, and f has no unique decomposition. Shapley effects
// share the variance between them (Owen 2014, SIAM/ASA J. Uncertain. Quantif. 2, 245; Song, Nelson & Staum 2016, ibid.
// 4, 1060). They are not negative, add to one, and do not depend on the order of the columns:
//
//   V H_j       =  sum over the subsets u without j of |u|! (d - |u| - 1)!/d! (W(u + j) - W(u)),  W(u) = Var E[f | x_u]
//   W(u)        =  E[(f(A) - mean)(f(A^u) - mean)],  A^u: the factors u as in A, the others drawn given these
//
// Given a part of the columns of a sample, A^u has one of the four rows nearest to the row of A in these columns, in
// standard deviations (Broto, Bachoc & Depecker 2020, SIAM/ASA J. Uncertain. Quantif. 8, 693).
//
// f is the model's mean, so no share includes the scatter of runs. The equations follow from the Hoeffding
// decomposition of f. The differences remove all parts without the factors (Liu & Owen 2006, J. Am. Stat. Assoc. 101,
// 712). The product of the differences at A and at B removes the parts with further factors (Owen, Dick & Chen 2014,
// Inf. Inference 3, 59). For an additive f, interactions are 0 at every single point, not only on average. Points: 8
// independent scramblings of 1,024 points of a Sobol sequence of twice the dimensions.
//
// Half-widths: five parts in quadrature.
//
//   jackknife    over models each without one group of cases (hyperparameters kept, response/kriging.hpp)
//   its bias     (G - 1) (mean of these models - the whole model)
//   integration  Student t over the scramblings
//   missed       leave-one-out error^2 minus the share of scatter
//   hidden       leave-one-out error^2 7.81/n: three coefficients that the residuals of n cases may hide, so that the
//                index of a factor without influence on the model still has an error
#pragma once

#include "stats/joint_sample.hpp"
#include "stats/response_model.hpp"
#include "stats/sensitivity.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Function from points of the factors' box [0, 1]^d to features; both row-major.
using FeatureMap = std::function<std::vector<double>(Rows factors)>;

struct ModelIndices {
    std::vector<SensitivityIndex> first;         ///< per factor
    std::vector<SensitivityIndex> total;         ///< per factor
    std::vector<SensitivityIndex> interactions;  ///< per factor, T_j - S_j
    std::vector<SensitivityIndex> pairs;         ///< S_jk for j < k, by rows: (0, 1), (0, 2), ..., (1, 2), ...

    /// Part of a control factor's range in which the variance from noise is smallest.
    struct Calmest {
        std::size_t factor = 0;
        double from = 0, to = 1;  ///< in the factor's coordinate u
        SensitivityIndex left;    ///< share of the variance over the whole box
        SensitivityIndex saved;   ///< total of the noise minus `left`, with the error of this difference

        /// Returns whether `saved` is above 0 by three standard errors, because the smallest of many parts is chosen.
        [[nodiscard]] bool significant() const { return saved.value > 1.5 * saved.half_width; }
    };
    struct Noise {
        SensitivityIndex total;
        std::vector<Calmest> controls;  ///< the smallest first
    };
    std::optional<Noise> noise;             ///< empty: no factor is noise, or all are
    std::vector<SensitivityIndex> shapley;  ///< per factor; empty: all are independent, or there are too many
};

/// Most factors of which Shapley effects are computed; their number of subsets is 2^factors.
inline constexpr std::size_t most_shared_factors = 8;

/// Roles and levels of the factors.
struct FactorRoles {
    std::vector<bool> noise;                            ///< empty: no factor is noise
    std::vector<std::size_t> levels;                    ///< 0, or empty: continuous
    std::vector<std::optional<SampleColumn>> together;  ///< column of a sample with several; empty: all are independent
};

/// Returns the indices. `groups`: group of every row that the model was fitted to, such as its sequence, at least 2
/// different ones; empty: 8 consecutive batches. `features`: empty if the factors are the features, in the model's
/// box. Throws std::invalid_argument if sizes do not match or cases were added to the model.
[[nodiscard]] ModelIndices model_indices(const ResponseModel& model, std::size_t factors,
                                         std::span<const std::size_t> groups = {}, const FeatureMap& features = {},
                                         const FactorRoles& roles = {});

}  // namespace grainsweep::stats
