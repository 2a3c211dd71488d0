// A probability as a function of the factors, learned from cases that did or did not: whether a case has an answer,
// whether an observable is defined, an observable of 0 and 1 such as `jammed`.
//
//   P(1 at x) = Phi(f(x)),   f a Gaussian process of constant mean, Matern 5/2, one length per feature
//
// The mean of f is unknown, N(0, 2^2). f follows from the cases by expectation propagation (Rasmussen & Williams 2006,
// section 3.6: response/expectation.hpp), which keeps the probabilities calibrated where the Laplace approximation of
// their section 3.4 draws them to 1/2 (Kuss & Rasmussen 2005, J. Mach. Learn. Res. 6, 1679). Cases at one place are
// counted together, so that replicates count as what they are. P is the average over the likely lengths and s^2
// (response/likely_hyperparameters.hpp): one best guess places a sharp border too surely. Of more than 200 places the
// best guess stands alone, from 200 of them, half of these with the rarer outcome.
//
//   P(x) = Phi(m/sqrt(1 + v)),  f(x) ~ N(m, v)                                                          (eq. 3.82)
//   error^2 = E Phi(f)^2 - P^2 = Phi(h) - 2 T(h, 1/sqrt(1 + 2 v)) - P^2,  h = m/sqrt(1 + v),  T Owen's function
//
// P and E Phi(f)^2 are averaged; m and v of a prediction are of the normal f that has these averages. A single run
// scatters by sqrt(P (1 - P)). Of more than 1,000 places a subset that fills the space is used. Nothing is drawn.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace grainsweep::stats {

struct ProbabilityQuality {
    std::size_t cases = 0;     ///< that were seen
    std::size_t ones = 0;      ///< of them
    std::size_t rests_on = 0;  ///< cases in the model
    /// Mean square of 1 or 0 minus the probability that the other places predict (Brier 1950), and the same of the
    /// share of ones alone.
    double brier = 0, brier_of_share = 0;
    std::vector<double> lengths;  ///< per feature, in widths of the box
};

/// Cheap to copy.
class ProbabilityModel {
public:
    struct State;
    explicit ProbabilityModel(std::shared_ptr<const State> state) : state_(std::move(state)) {}

    /// Features in their own units. `latent` of every prediction is set, `freedom` infinite.
    [[nodiscard]] std::vector<Prediction> predict(Rows points) const;
    /// Probabilities only.
    [[nodiscard]] std::vector<double> probabilities(Rows points) const;
    /// Whether P is at least 1/2 under the likeliest hyperparameters, at a cost of n per point.
    [[nodiscard]] std::vector<bool> likely(Rows points) const;
    /// The model with cases added, hyperparameters as they are; a value between 0 and 1 is a share of a case.
    [[nodiscard]] ProbabilityModel with_cases(Rows points, std::span<const double> values) const;

    [[nodiscard]] const ProbabilityQuality& quality() const;
    [[nodiscard]] std::size_t dimensions() const;

private:
    std::shared_ptr<const State> state_;
};

/// Whether a response is a probability's: every finite value is 0 or 1, and both occur.
[[nodiscard]] bool only_zero_and_one(std::span<const double> values);

/// Fits. `values`: 0 or 1 of each row of `points`; one that is not finite is left out. `low`, `high`: box of the
/// features. Refuses a feature that is not finite, and equations that are singular. Throws std::invalid_argument where
/// sizes do not match, the box is empty, or a value is neither 0 nor 1.
[[nodiscard]] std::variant<ProbabilityModel, Refusal> fit_probability(Rows points, std::span<const double> values,
                                                                      std::span<const double> low,
                                                                      std::span<const double> high);

}  // namespace grainsweep::stats
