// Posterior density that the hyperparameters of a response model maximise, with its gradient.
//
//   log p(z | h) = -1/2 (z - b 1)^T K^-1 (z - b 1) - 1/2 log|K| - n/2 log 2 pi,   K = s^2 C + g I
//   b = 1^T K^-1 z / 1^T K^-1 1                         (Rasmussen & Williams 2006, eq. 2.30, 5.8; b at its maximum)
//   d/dt = 1/2 sum_ij (a a^T - K^-1)_ij dK_ij/dt,       a = K^-1 (z - b 1)      (eq. 5.9; b adds nothing at a maximum)
//
// plus the logarithms of the priors: log l_j ~ N(0, 1.5^2), log g ~ N(log 0.02, 2^2), U_jk ~ N(0, 1) (constants left
// out); s^2 has none. All derivatives by the map M = L^-1 U come from one d x d matrix: with G = 1/2 (a a^T - K^-1) o
// s^2 dC/d(r^2) and S = sum_ij G_ij (x_i - x_j)(x_i - x_j)^T = 2 X^T (diag(G 1) - G) X, d/dM = 2 M S: one inverse and
// n^2 d operations for any number of lengths.
//
// Parameters in a row: log l (d), log s^2, log g, then U above its diagonal by rows (d (d - 1)/2) where it is learned.
#pragma once

#include "stats/response/matern.hpp"

#include <Eigen/Core>

namespace grainsweep::stats::response {

/// Likelihood of features in their boxes (n, d) and standardised responses.
class Likelihood {
public:
    Likelihood(Eigen::MatrixXd points, Eigen::VectorXd values, bool learns_map);

    [[nodiscard]] Eigen::Index parameters() const;
    [[nodiscard]] Hyperparameters hyperparameters(const Eigen::VectorXd& parameters) const;
    [[nodiscard]] Eigen::VectorXd parameters(const Hyperparameters& h) const;

    /// Returns the log posterior density up to a constant; minus infinity if K is singular in double precision.
    [[nodiscard]] double value(const Eigen::VectorXd& parameters) const;
    /// Returns the same and sets its gradient (zero where it is minus infinity).
    double value(const Eigen::VectorXd& parameters, Eigen::VectorXd& gradient) const;

    [[nodiscard]] const Eigen::MatrixXd& points() const { return points_; }
    [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }

private:
    [[nodiscard]] double log_prior(const Hyperparameters& h, Eigen::VectorXd* gradient) const;

    Eigen::MatrixXd points_;
    Eigen::VectorXd values_;
    bool learns_map_;
};

}  // namespace grainsweep::stats::response
