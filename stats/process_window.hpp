// Probability that a condition on several responses holds, and the expected improvement of a further case.
//
// Predictions of different responses are taken as independent.
//
//   P(condition at x) = integral over the responses y_k = mean_k(x) + e_k(x) t,  t of Student's distribution
//       e_k = standard error of the mean, or of a single run including its scatter; degrees of freedom: Prediction
//
// A response that is a probability (stats/probability_model.hpp) is Phi(f), f normal; a single run of it is 1 or 0.
//
// Of a single run the promise must outlast a search, which finds the settings whose scatter is estimated too small.
// There the scatter s is
//
//   s^2 = min(f s_local^2/q, max(s_local^2, s_even^2)),   q: 10 % quantile of chi-squared, f degrees of freedom
//
// and the error of the mean counts twice. s_local from the f or so cases about x, s_even from all; and where a quantile
// of the residuals of left-out cases lies farther out than that of Student's distribution, it is taken instead: errors
// of runs need not be normal.
//
// The integral uses 1,024 Sobol points, the same for all x, so that contours are smooth (error about 0.002).
//
// Next cases: augmented expected improvement of Huang, Allen, Notz & Zeng (2006), J. Global Optim. 34, 441, eq. 12
// times the probability that the condition holds (Schonlau, Welch & Jones 1998):
//
//   A(x) = P(x) [ (m - m*) Phi(u) + s phi(u) ] (1 - g/sqrt(s^2 + g^2)),   u = (m - m*)/s
//
// m, s, g: mean of the objective (maximised), its error, and the scatter of one run. m*: mean at the effective best.
// This is the setting with the largest m - s among the settings where the condition holds with P > 1/2.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Quantity that a condition refers to: the mean response, or a single run.
enum class Judged { mean, single_run };

/// Function that returns whether the condition holds; one value per model, in their order.
using Condition = std::function<bool(std::span<const double> responses)>;

/// Errors of the responses at the integration points, in standard errors: quantiles of each model's distribution. The
/// object can be used for all models with these degrees of freedom; making it takes longer than computing a
/// probability.
class SampledErrors {
public:
    /// `freedom`: degrees of freedom of each model (ResponseModel::freedom), in their order. `scores`: residuals of
    /// left-out cases over their errors, of each model whose single runs are judged; fewer than 40 say nothing.
    explicit SampledErrors(std::span<const double> freedom, std::span<const std::vector<double>> scores = {});

    [[nodiscard]] std::size_t models() const { return models_; }
    [[nodiscard]] std::size_t points() const;
    /// Returns sqrt(f/q) of the header, by which a local scatter may be larger than its estimate.
    [[nodiscard]] double widest(std::size_t model) const { return widest_[model]; }
    /// Returns the same with the 90 % quantile: by how little a local scatter may be.
    [[nodiscard]] double narrowest(std::size_t model) const { return narrowest_[model]; }
    /// Returns one error per model at an integration point.
    [[nodiscard]] std::span<const double> at(std::size_t point) const {
        return std::span(errors_).subspan(point * models_, models_);
    }

private:
    std::size_t models_;
    std::vector<double> errors_;  ///< (points, models)
    std::vector<double> widest_, narrowest_;
};

/// Returns the probability that a condition holds at each point: predictions[k][i] of model k at point i. Throws
/// std::invalid_argument if `errors` has another number of models.
[[nodiscard]] std::vector<double> probability_of(std::span<const std::vector<Prediction>> predictions,
                                                 const Condition& condition, Judged judged,
                                                 const SampledErrors& errors);

/// Returns the last factor of A(x): the part of the error of the mean that one run removes.
[[nodiscard]] double learned(const Prediction& objective);
/// Returns A(x) of every point. If P > 1/2 nowhere, returns P.
[[nodiscard]] std::vector<double> expected_improvement(std::span<const Prediction> objective,
                                                       std::span<const double> probability, bool maximise);

/// Returns the indices of the points that are not dominated (no other point is better in one value and not worse in the
/// other), by ascending first value.
[[nodiscard]] std::vector<std::size_t> trade_off_front(std::span<const double> first, bool maximise_first,
                                                       std::span<const double> second, bool maximise_second);

}  // namespace grainsweep::stats
