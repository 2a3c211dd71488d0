// Noise that is not the same everywhere, without a second process for it: predicted variances are multiplied by
//
//   factor(x) = (sum over the k nearest cases of t_i^2 + 4)/(k + 4),   k = sqrt(n)/1.5,
//
// t_i: leave-one-out residual over its predicted standard deviation, distance: the kernel's. The 4 and 4 are four cases
// of the expected size (an inverse-gamma prior of mean about 1 on the local variance), so that few neighbours say
// little.
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace grainsweep::stats::response {

struct LocalNoise {
    Eigen::MatrixXd points;          ///< mapped (n, d)
    Eigen::VectorXd squared_scores;  ///< t_i^2

    /// At mapped points (m, d). Where these are the cases, each may be left out of its own factor.
    [[nodiscard]] Eigen::VectorXd factors(const Eigen::MatrixXd& at, bool without_self = false) const;
    [[nodiscard]] Eigen::Index neighbours() const;
    /// Degrees of freedom, k + 4.
    [[nodiscard]] std::int64_t freedom() const;
};

}  // namespace grainsweep::stats::response
