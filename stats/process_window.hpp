// Where a condition on several responses holds, and what a case there would gain.
//
// Predictions of different responses are taken as independent of one another.
//
//   P(condition at x) = integral over the responses y_k = mean_k(x) + e_k(x) t,  t of Student's distribution
//       e_k = standard error of the mean (is the mean response inside?), or of a single run with its scatter; degrees
//       of freedom as Prediction says (all of one model alike)
//
// A response that is a probability (stats/probability_model.hpp) is Phi(f), f normal; each single run of it is 1 or 0.
//
// It is integrated over 1,024 Sobol points, the same for all x, so that contours are smooth (error about 0.002).
//
// Next cases: augmented expected improvement of Huang, Allen, Notz & Zeng (2006), J. Global Optim. 34, 441, eq. 12
// times the probability that the condition holds (Schonlau, Welch & Jones 1998):
//
//   A(x) = P(x) [ (m - m*) Phi(u) + s phi(u) ] (1 - g/sqrt(s^2 + g^2)),   u = (m - m*)/s
//
// m, s, g: mean, its error and scatter of one run of the objective (maximised); m*: mean at the effective best, the
// setting of largest m - s among those where the condition is more likely met than not.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// What a condition is about: the mean response, or each single run.
enum class Judged { mean, single_run };

/// One value per model, in their order -> whether the condition holds.
using Condition = std::function<bool(std::span<const double> responses)>;

/// Errors of the responses at the integration points, in standard errors: quantiles of each model's distribution. One
/// serves all probabilities of models with these degrees of freedom; making it takes longer than a probability.
class SampledErrors {
public:
    /// One number of degrees of freedom per model (ResponseModel::freedom), in their order.
    explicit SampledErrors(std::span<const double> freedom);

    [[nodiscard]] std::size_t models() const { return models_; }
    [[nodiscard]] std::size_t points() const;
    /// One error per model at an integration point.
    [[nodiscard]] std::span<const double> at(std::size_t point) const {
        return std::span(errors_).subspan(point * models_, models_);
    }

private:
    std::size_t models_;
    std::vector<double> errors_;  ///< (points, models)
};

/// Probability that a condition holds at each point: predictions[k][i] of model k at point i. Throws
/// std::invalid_argument where `errors` is of another number of models.
[[nodiscard]] std::vector<double> probability_of(std::span<const std::vector<Prediction>> predictions,
                                                 const Condition& condition, Judged judged,
                                                 const SampledErrors& errors);

/// A(x) of every point. Where the condition is nowhere more likely than not: P alone.
[[nodiscard]] std::vector<double> expected_improvement(std::span<const Prediction> objective,
                                                       std::span<const double> probability, bool maximise);

/// Indices of the points that no other point beats in one figure without losing in the other, by growing first figure.
[[nodiscard]] std::vector<std::size_t> trade_off_front(std::span<const double> first, bool maximise_first,
                                                       std::span<const double> second, bool maximise_second);

}  // namespace grainsweep::stats
