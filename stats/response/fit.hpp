// The search for the hyperparameters: maximum of the posterior by L-BFGS with bounds (Nocedal 1980; Liu & Nocedal 1989;
// NLopt's LD_LBFGS) from several starts.
//
// Starts are Sobol points over log l in [-1.5, 1.5], log s^2 in [-0.5, 2], log g in [log 0.001, log 0.3]; eight times
// as many as are searched from are compared first. All this on at most 200 cases; the best two maxima are then followed
// on at most `cases` of them, and what was found, where it is asked for, on more (`follow`). Cases are chosen by a
// fixed permutation: no draw, the same every time. Bounds: l in [0.02, 50] widths of the box, s^2 in [e^-4, e^6], g in
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

/// `count` of n rows by a fixed permutation, ascending; all where there are no more.
[[nodiscard]] std::vector<Eigen::Index> spread_choice(Eigen::Index n, std::size_t count);

/// One length per feature. None where every start is singular.
[[nodiscard]] std::optional<Hyperparameters> fit_lengths(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                                         const FitSettings& settings);

/// A linear map besides, starting from fitted lengths.
[[nodiscard]] std::optional<Hyperparameters> fit_map(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                                     const Hyperparameters& lengths, const FitSettings& settings);

/// Lengths, and the linear map where it is asked for and lowers the leave-one-out error on the cases of the search.
[[nodiscard]] std::optional<Hyperparameters> find_hyperparameters(const Eigen::MatrixXd& points,
                                                                  const Eigen::VectorXd& values,
                                                                  const FitSettings& settings);

/// The maximum that these lead to on at most `cases` of the cases; of a linear map where they have one. They themselves
/// where K is singular.
[[nodiscard]] Hyperparameters follow(const Hyperparameters& found, const Eigen::MatrixXd& points,
                                     const Eigen::VectorXd& values, std::size_t cases);

/// Root mean square of leave-one-out residuals over (at most `cases` of) the cases; infinite where K is singular.
[[nodiscard]] double leave_one_out_rms(const Hyperparameters& h, const Eigen::MatrixXd& points,
                                       const Eigen::VectorXd& values, std::size_t cases);

/// Greedy maximin: the row nearest the middle, then always the row farthest from those chosen; ties to the lower
/// index. n m d operations.
[[nodiscard]] std::vector<Eigen::Index> space_filling_choice(const Eigen::MatrixXd& points, std::size_t count);

}  // namespace grainsweep::stats::response
