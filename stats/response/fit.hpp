// Search for the hyperparameters: maximum of the posterior by L-BFGS with bounds (Nocedal 1980; Liu & Nocedal 1989;
// NLopt's LD_LBFGS) from several starts.
//
// Starts are Sobol points with log l in [-1.5, 1.5], log s^2 in [-0.5, 2], log g in [log 0.001, log 0.3]. Eight times
// as many points as starts are compared first. This search uses at most 200 cases. The best two maxima are then
// followed on at most `cases` cases and, on request, the result on more cases (`follow`). A fixed permutation chooses
// the cases, so the choice is always the same. Bounds: l in [0.02, 50] widths of the box, s^2 in [e^-4, e^6], g in
// [1e-8, 2] (of the variance of the responses), U_jk in [-5, 5]. A noise at its lower bound stands for a response
// without noise.
#pragma once

#include "stats/response/likelihood.hpp"
#include "stats/response_model.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace grainsweep::stats::response {

inline constexpr double smallest_noise = 1e-8;

struct FitSettings {
    std::size_t starts = 6;
    std::size_t cases = 500;
    LearnedMap map = LearnedMap::where_better;  ///< of find_hyperparameters
};

/// Returns `count` of n rows, chosen by a fixed permutation, ascending; all rows if n is not larger.
[[nodiscard]] std::vector<Eigen::Index> spread_choice(Eigen::Index n, std::size_t count);

/// Returns hyperparameters with one length per feature. Empty if every start is singular.
[[nodiscard]] std::optional<Hyperparameters> fit_lengths(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                                         const FitSettings& settings);

/// Returns hyperparameters with a linear map, starting from fitted lengths.
[[nodiscard]] std::optional<Hyperparameters> fit_map(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                                     const Hyperparameters& lengths, const FitSettings& settings);

/// Returns lengths, and the linear map if it is requested and lowers the leave-one-out error on the cases of the
/// search.
[[nodiscard]] std::optional<Hyperparameters> find_hyperparameters(const Eigen::MatrixXd& points,
                                                                  const Eigen::VectorXd& values,
                                                                  const FitSettings& settings);

/// Returns the maximum that the search reaches from `found` on at most `cases` cases, with a linear map if `found` has
/// one. Returns `found` if K is singular.
[[nodiscard]] Hyperparameters follow(const Hyperparameters& found, const Eigen::MatrixXd& points,
                                     const Eigen::VectorXd& values, std::size_t cases);

/// Returns the root mean square of the leave-one-out residuals of at most `cases` cases; infinite if K is singular.
[[nodiscard]] double leave_one_out_rms(const Hyperparameters& h, const Eigen::MatrixXd& points,
                                       const Eigen::VectorXd& values, std::size_t cases);

/// Returns a space-filling choice of rows by greedy maximin: the row nearest to the middle, then always the row
/// farthest from the chosen rows; ties go to the lower index. n m d operations.
[[nodiscard]] std::vector<Eigen::Index> space_filling_choice(const Eigen::MatrixXd& points, std::size_t count);

}  // namespace grainsweep::stats::response
