// Calibration of inputs to measurements: history matching and likelihood.
//
//   I^2(x) = (z - mean(x))^2 / (var_model(x) + var_measured + var_discrepancy + var_run(x)/replicates)
//
// (Vernon, Goldstein & Bower 2010, Bayesian Analysis 5, 619, eq. 7; the scatter of runs: Andrianakis et al. 2015, PLoS
// Comput. Biol. 11, e1003968.) A setting with I > 3 for some target is ruled out (Pukelsheim's three sigma rule). With
// more than five targets the second largest I decides, so that one bad model does not rule out the truth.
//
// Predictions with n degrees of freedom follow Student's t, whose variance is n/(n - 2) times the squared error. Both
// var_model and var_run are multiplied by this factor (1.33 for n = 8, a model with about ten cases nearby).
//
//   log p(z | x) = -1/2 r^T V^-1 r - 1/2 log|V|,   V = diag(var_model(x) + var_run(x)/replicates) + C,  r = z - mean(x)
//
// C: covariance of measurement and discrepancy: diagonal from the targets, or a full matrix if the errors of the points
// of one curve are correlated.
#pragma once

#include "stats/response_model.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Measurement of one response, in its unit.
struct Target {
    double value = 0;
    double measured_error = 0;  ///< standard error of the measurement
    double discrepancy = 0;     ///< standard deviation of the effects that the simulation does not model
    std::int64_t replicates =
        1;  ///< runs (or turns, or images) that the measurement averages; 0: measured_error includes the scatter
};

/// Returns the implausibilities I of every target at every point: predictions[k][i] of target k at point i -> [k][i].
/// Throws std::invalid_argument where sizes differ or a denominator is zero.
[[nodiscard]] std::vector<std::vector<double>> implausibilities(std::span<const Target> targets,
                                                                std::span<const std::vector<Prediction>> predictions);

/// Returns the implausibility that decides at each point: the largest, or, with more than five targets, the second
/// largest.
[[nodiscard]] std::vector<double> deciding_implausibility(std::span<const std::vector<double>> implausibilities);

/// Returns log p(z | x) up to a constant, at each point. `covariance`: C, row-major, or empty (diagonal of the
/// targets). Throws std::invalid_argument where sizes differ or V is not positive definite.
[[nodiscard]] std::vector<double> log_likelihood(std::span<const Target> targets,
                                                 std::span<const std::vector<Prediction>> predictions,
                                                 std::span<const double> covariance = {});

/// Returns the distance of a target from the range of the computed responses, divided by its standard deviation
/// (measurement and discrepancy together); 0 inside the range.
[[nodiscard]] double beyond_what_was_reached(const Target& target, std::span<const double> responses);

}  // namespace grainsweep::stats
