// d2/dx2 along one axis of a staggered, possibly clustered grid:
//   (L a)_i = low_i (a_{i-1} - a_i) + high_i (a_{i+1} - a_i),
// the divergence of the two-point gradient, on cells or on faces.
#pragma once

#include "solver/flow/boundary.hpp"

#include <Eigen/Core>

#include <vector>

namespace grainsweep::flow {

struct SecondDifference {
    std::vector<double> low, high;  ///< 1/length^2, indices as the field's: 0 ... n+1, defined where unknown

    SecondDifference(const Axis& axis, const Edge& edge);
};

/// Returns L as a matrix on indices 1 ... n with the ghosts eliminated (their constants belong to the right-hand side).
/// Rows and columns of known values are zero.
[[nodiscard]] Eigen::MatrixXd second_difference_matrix(const Axis& axis, const Edge& edge);

}  // namespace grainsweep::flow
