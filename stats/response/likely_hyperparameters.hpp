// Hyperparameters of a probability (expectation.hpp) that are likely after its trials, with their weights.
//
// theta = (log l_1, ..., log l_d, log s^2) has the density
//
//   p(theta | trials) ~ evidence(theta) prod_j N(log l_j | 0, 1.5^2) N(log s^2 | log 400, 2^2)
//
// A large s stands for a sharp border. Its maximum is climbed to from the two best of eight Sobol starts. About the
// maximum stand two places on each axis of the curvature there, sqrt(m + 2) widths away, m = d + 1. The weights
//
//   2/(m + 2) of the maximum, 1/(2 (m + 2)) of each other place
//
// give a normal density its mean, variance and E r^4 (Julier & Uhlmann 2004, Proc. IEEE 92, 401). Each place is
// multiplied by the ratio of the density there to the normal one, at most e^2; then weights are divided by their sum.
#pragma once

#include "stats/response/expectation.hpp"

#include <vector>

namespace grainsweep::stats::response {

struct LikelyHyperparameters {
    double weight = 1;
    Hyperparameters h;
};

enum class Wanted { maximum, places_about_it };

/// Finds the maximum, first in the list, and where wanted the places about it. Empty where the equations are singular
/// at every start. Nothing is drawn.
[[nodiscard]] std::vector<LikelyHyperparameters> likely_hyperparameters(const Trials& trials, Wanted wanted);

}  // namespace grainsweep::stats::response
