// Gaussian approximation of a latent function that is observed through successes and failures only, by expectation
// propagation (Rasmussen & Williams 2006, section 3.6; Minka 2001).
//
//   f ~ N(0, K),   K = s^2 C(r) + c^2,   P(success at x) = Phi(f(x))
//   p(f | y) ~ N(f | mu, Sigma),  Sigma = (K^-1 + T)^-1,  mu = Sigma nu,  T = diag(tau)                 (eq. 3.53)
//
// c = 2 is the standard deviation of the unknown mean of f: Phi(-2) to Phi(2) is 0.023 to 0.977. A place with m trials,
// k of them successes, has one factor Phi(f)^k Phi(-f)^(m-k); k may be a fraction. Its moments under the cavity
// distribution (eq. 3.56 to 3.59) are integrated by the trapezoidal rule around their mode. All factors are updated
// together with damping, until no mean changes by 1e-5 standard deviations, for at most 100 rounds. The log evidence is
// eq. 3.65 in the form of eq. 3.73 and 3.74, its gradient eq. 5.27.
#pragma once

#include "stats/response/matern.hpp"

#include <Eigen/Core>

#include <optional>

namespace grainsweep::stats::response {

/// Observations: places, one row each, with trials and successes.
struct Trials {
    Eigen::MatrixXd points;     ///< features in their boxes (n, d)
    Eigen::VectorXd count;      ///< m
    Eigen::VectorXd successes;  ///< k
};

struct Expectation {
    Hyperparameters h;
    Eigen::MatrixXd points;                        ///< mapped (n, d)
    Eigen::VectorXd tau, nu;                       ///< parameters of the factors
    Eigen::MatrixXd factor;                        ///< L of B = I + T^1/2 K T^1/2 = L L^T, lower half
    Eigen::VectorXd weights;                       ///< (I - T^1/2 B^-1 T^1/2 K) nu
    Eigen::VectorXd cavity_mean, cavity_variance;  ///< f at each place without the factor of the place
    double log_evidence = 0;
};

/// Returns the approximation, starting from the factors of `before` if their number is the same. Empty if B is singular
/// in double precision.
[[nodiscard]] std::optional<Expectation> propagate(const Hyperparameters& h, const Trials& trials,
                                                   const Expectation* before = nullptr);

/// Returns the gradient of the log evidence by log l_j, then log s^2.
[[nodiscard]] Eigen::VectorXd evidence_gradient(const Expectation& found);

struct Latent {
    Eigen::VectorXd mean, variance;
};
/// Returns f at mapped points (m, d).
[[nodiscard]] Latent predict(const Expectation& found, const Eigen::MatrixXd& at);
[[nodiscard]] Eigen::VectorXd predict_means(const Expectation& found, const Eigen::MatrixXd& at);

/// Returns log Phi(f), with full relative accuracy for any f.
[[nodiscard]] double log_normal_cdf(double f);

}  // namespace grainsweep::stats::response
