// Likely hyperparameters of a probability (expectation.hpp) given its trials, with their weights.
//
// theta = (log l_1, ..., log l_d, log s^2) has the density
//
//   p(theta | trials) ~ evidence(theta) prod_j N(log l_j | 0, 1.5^2) N(log s^2 | log 400, 2^2)
//
// A large s means a sharp border. The maximum of the density is searched from the two best of eight Sobol starts. Two
// places lie on each axis of the curvature at the maximum, at a distance of sqrt(m + 2) widths, m = d + 1. The weights
//
//   2/(m + 2) of the maximum, 1/(2 (m + 2)) of each other place
//
// give a normal density its mean, variance and E r^4 (Julier & Uhlmann 2004, Proc. IEEE 92, 401). Each weight is
// multiplied by the ratio of the density to the normal density at its place, at most e^2. Then the weights are divided
// by their sum.
#pragma once

#include "stats/response/expectation.hpp"

#include <vector>

namespace grainsweep::stats::response {

struct LikelyHyperparameters {
    double weight = 1;
    Hyperparameters h;
};

enum class Wanted { maximum, places_about_it };

/// Returns the maximum and then, on request, the places around it. Empty if the equations are singular at every start.
/// No random numbers are used.
[[nodiscard]] std::vector<LikelyHyperparameters> likely_hyperparameters(const Trials& trials, Wanted wanted);

}  // namespace grainsweep::stats::response
