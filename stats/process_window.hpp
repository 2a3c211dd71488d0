// Where a condition on several responses holds, which setting is best there, and which cases to run next.
//
// Models of different responses are taken as independent of one another; each has features of its own, so that every
// model comes with the same points in its own features.
//
//   P(condition at x) = integral over the responses y_k = mean_k(x) + e_k(x) t,  t of Student's distribution
//       e_k = standard error of the mean (is the mean response inside?), or of a single run with its scatter; degrees
//       of freedom as Prediction says (all of one model alike)
//
// Bounds low <= y_k <= high for all k have a closed form (a product); any other condition is
// integrated over 1,024 Sobol points, the same for all x, so that contours are smooth (error about 0.002).
//
// Next cases: augmented expected improvement of Huang, Allen, Notz & Zeng (2006), J. Global Optim. 34, 441, eq. 12
// times the probability that the condition holds (Schonlau, Welch & Jones 1998):
//
//   A(x) = P(x) [ (m - m*) Phi(u) + s phi(u) ] (1 - g/sqrt(s^2 + g^2)),   u = (m - m*)/s
//
// m, s, g: mean, its error and scatter of one run of the objective (maximised); m*: mean at the effective best, the
// setting of largest m - s among those where the condition is more likely met than not. Several at a time by
// fantasies (the "kriging believer" of Ginsbourger, Le Riche & Carraro 2010): the chosen case is added to all models
// with its predicted response, which leaves means and shrinks errors, and the next is chosen. Without an objective:
// where the condition is least decided, largest min(P, 1 - P).
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// A model and the points asked, in its features. All of one call have the same number of points.
struct ModelAt {
    ResponseModel model;
    Rows points;
};

/// What a condition is about: the mean response, or each single run.
enum class Judged { mean, single_run };

/// low <= response <= high.
struct Bounds {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Probability that all responses lie in their bounds, at each point.
/// Throws std::invalid_argument where the numbers of models, bounds or points differ.
[[nodiscard]] std::vector<double> probability_within(std::span<const ModelAt> models, std::span<const Bounds> bounds,
                                                     Judged judged);

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

/// Probability that any condition holds, at each point.
[[nodiscard]] std::vector<double> probability_of(std::span<const ModelAt> models, const Condition& condition,
                                                 Judged judged);
/// The same from predictions already made: predictions[k][i] of model k at point i. Throws std::invalid_argument where
/// `errors` is of another number of models.
[[nodiscard]] std::vector<double> probability_of(std::span<const std::vector<Prediction>> predictions,
                                                 const Condition& condition, Judged judged,
                                                 const SampledErrors& errors);

struct Objective {
    std::size_t model = 0;  ///< index of the model that is maximised
    bool maximise = true;   ///< false: minimised
};

/// The setting with the best predicted mean among those where the condition holds with probability 1 - risk; none
/// where there is no such setting. Ties go to the lower index. Never the luckiest run: no response is looked at.
[[nodiscard]] std::optional<std::size_t> best_setting(std::span<const Prediction> objective,
                                                      std::span<const double> probability, bool maximise,
                                                      double risk = 0.05);

/// A(x) of every point. `scale`: see above. Where the condition is nowhere more likely than not: P alone.
[[nodiscard]] std::vector<double> expected_improvement(std::span<const Prediction> objective,
                                                       std::span<const double> probability, bool maximise);

/// The next `count` cases among the candidates, best first; fewer where no candidate promises anything. `condition`
/// may be empty (holds everywhere), `objective` too (then: where the condition is least decided), not both.
[[nodiscard]] std::vector<std::size_t> next_cases(std::span<const ModelAt> candidates, const Condition& condition,
                                                  std::optional<Objective> objective, Judged judged, std::size_t count);

/// Indices of the points that no other point beats in one figure without losing in the other, by growing first figure.
[[nodiscard]] std::vector<std::size_t> trade_off_front(std::span<const double> first, bool maximise_first,
                                                       std::span<const double> second, bool maximise_second);

}  // namespace grainsweep::stats
