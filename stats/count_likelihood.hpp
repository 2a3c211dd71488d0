// Likelihood of a count: k of n runs of an experiment had an outcome whose probability a model predicts.
//
//   q | x ~ Beta(P/t, (1 - P)/t)      probability of the experiment
//   k | q ~ Binomial(n, q)            count
//
//   p(k | x) = C(n, k) prod_{i<k} (P + i t) prod_{i<n-k} (1 - P + i t) / prod_{i<n} (1 + i t)
//
// the beta-binomial distribution (Skellam 1948, J. R. Stat. Soc. B 10, 257). q has the mean P(x) of the model and the
// variance s^2 = e^2 + 4 d^2 (P (1 - P) - e^2): e the standard error of P, d the discrepancy, which is the standard
// deviation of q about the true P where P is 1/2. t = s^2/(P (1 - P) - s^2). With t = 0 the count is binomial.
//
// Functions throw std::invalid_argument unless 0 <= count <= of, of > 0 and 0 <= d < 1/2.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Measured count: `count` of `of` independent runs had the outcome.
struct CountTarget {
    std::size_t count = 0, of = 1;
    double discrepancy = 0;  ///< d, below 1/2
};

/// Returns log p(k | x) for the prediction of the probability at each point; minus infinity: impossible.
[[nodiscard]] std::vector<double> log_likelihood_of_count(const CountTarget& target,
                                                          std::span<const Prediction> predictions);

/// Returns the implausibility I of the count at each point, I^2 = 2 (log p(k | P = k/n) - log p(k | x)) with the t of
/// the point. For a normal response this is the I of stats/calibration.hpp.
[[nodiscard]] std::vector<double> implausibilities_of_count(const CountTarget& target,
                                                            std::span<const Prediction> predictions);

}  // namespace grainsweep::stats
