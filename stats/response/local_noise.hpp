// Noise that varies in space, without a second Gaussian process. Predicted variances are multiplied by
//
//   factor(x) = (sum over the k nearest cases of t_i^2 + 4)/(k + 4),   k = sqrt(n)/1.5,
//
// t_i: leave-one-out residual divided by its predicted standard deviation. Nearest means by the distance of the kernel.
// The two 4s act as four cases of the expected size (an inverse-gamma prior of mean about 1 on the local variance), so
// that few neighbours have little effect.
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace grainsweep::stats::response {

struct LocalNoise {
    Eigen::MatrixXd points;          ///< mapped (n, d)
    Eigen::VectorXd squared_scores;  ///< t_i^2

    /// Returns the factors at mapped points (m, d). `without_self`: the points are the cases, and each is left out of
    /// its own factor.
    [[nodiscard]] Eigen::VectorXd factors(const Eigen::MatrixXd& at, bool without_self = false) const;
    [[nodiscard]] Eigen::Index neighbours() const;
    /// Returns the degrees of freedom, k + 4.
    [[nodiscard]] std::int64_t freedom() const;
};

}  // namespace grainsweep::stats::response
