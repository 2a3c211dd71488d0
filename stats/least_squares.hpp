// Linear least squares of a few columns, which may depend on each other.
#pragma once

#include <Eigen/Core>

namespace grainsweep::stats {

/// Returns b with the smallest |y - A b|, by modified Gram-Schmidt with the longest column first (Björck 1967). Columns
/// that others give to rounding have coefficients of 0.
[[nodiscard]] Eigen::VectorXd least_squares(Eigen::MatrixXd columns, Eigen::VectorXd y);

}  // namespace grainsweep::stats
