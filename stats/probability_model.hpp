// Model of a probability as a function of the factors, fitted to cases with outcome 0 or 1. The outcome is, for
// example, whether a case has an answer, whether an observable is defined, or an observable such as `jammed`.
//
//   P(1 at x) = Phi(f(x)),   f a Gaussian process of constant mean, Matern 5/2, one length per feature
//
// The mean of f is unknown, N(0, 2^2). f follows from the cases by expectation propagation (Rasmussen & Williams 2006,
// section 3.6: response/expectation.hpp), which keeps the probabilities calibrated; the Laplace approximation of their
// section 3.4 pulls them to 1/2 (Kuss & Rasmussen 2005, J. Mach. Learn. Res. 6, 1679). Cases at one place are one
// binomial observation. P is the average over the likely lengths and s^2 (response/likely_hyperparameters.hpp), because
// the best lengths alone would make a sharp border too certain. With more than 200 places only the best hyperparameters
// are used, fitted to 200 places of which half have the rarer outcome.
//
//   P(x) = Phi(m/sqrt(1 + v)),  f(x) ~ N(m, v)                                                          (eq. 3.82)
//   error^2 = E Phi(f)^2 - P^2 = Phi(h) - 2 T(h, 1/sqrt(1 + 2 v)) - P^2,  h = m/sqrt(1 + v),  T Owen's function
//
// P and E Phi(f)^2 are averaged; m and v of a prediction belong to the normal f with these averages. A single run
// scatters by sqrt(P (1 - P)). If there are more than 1,000 places, a space-filling subset is used. No random numbers
// are used.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace grainsweep::stats {

struct ProbabilityQuality {
    std::size_t cases = 0;     ///< cases in the fit
    std::size_t ones = 0;      ///< cases with the value 1
    std::size_t rests_on = 0;  ///< cases in the model
    /// Mean square of the outcome (1 or 0) minus the probability predicted from the other places (Brier 1950), and the
    /// same with the share of ones as prediction.
    double brier = 0, brier_of_share = 0;
    std::vector<double> lengths;  ///< one per feature, in widths of the box
};

/// Fitted model. Cheap to copy.
class ProbabilityModel {
public:
    struct State;
    explicit ProbabilityModel(std::shared_ptr<const State> state) : state_(std::move(state)) {}

    /// Returns predictions at features in their own units. `latent` of every prediction is set, `freedom` is infinite.
    [[nodiscard]] std::vector<Prediction> predict(Rows points) const;
    /// Returns the probabilities with their standard errors, without `latent`, which takes most of the time.
    [[nodiscard]] std::vector<Prediction> with_errors(Rows points) const;
    /// Returns only the probabilities.
    [[nodiscard]] std::vector<double> probabilities(Rows points) const;
    /// Returns whether P is at least 1/2 with the most likely hyperparameters. Cost: n per point.
    [[nodiscard]] std::vector<bool> likely(Rows points) const;
    /// Returns the model with cases added and the same hyperparameters. A value between 0 and 1 is a fraction of a
    /// case.
    [[nodiscard]] ProbabilityModel with_cases(Rows points, std::span<const double> values) const;

    [[nodiscard]] const ProbabilityQuality& quality() const;
    [[nodiscard]] std::size_t dimensions() const;

private:
    std::shared_ptr<const State> state_;
};

/// Returns whether every finite value is 0 or 1, and both occur.
[[nodiscard]] bool only_zero_and_one(std::span<const double> values);

/// Fits a model. `values`: 0 or 1 for each row of `points`; a value that is not finite is left out. `low`, `high`: box
/// of the features. Refuses a feature that is not finite, and singular equations. Throws std::invalid_argument if sizes
/// do not match, the box is empty, or a value is neither 0 nor 1.
[[nodiscard]] std::variant<ProbabilityModel, Refusal> fit_probability(Rows points, std::span<const double> values,
                                                                      std::span<const double> low,
                                                                      std::span<const double> high);

}  // namespace grainsweep::stats
