// Inverses by blocks, so that nearly all work is in matrix products. Each needs n^3/3 multiplications and additions,
// the least that the structure allows (Golub & Van Loan 2013, section 3.1; LAPACK's trtri and lauum).
#pragma once

#include <Eigen/Core>

namespace grainsweep::stats::response {

/// Computes L <- L^-1 for a lower triangular matrix; the upper half is neither read nor written.
void invert_lower(Eigen::Ref<Eigen::MatrixXd> lower);

/// Returns the full symmetric matrix M^T M of a lower triangular M = L^-1, which is K^-1 for K = L L^T.
[[nodiscard]] Eigen::MatrixXd gram_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower);

/// Returns the diagonal of M^T M.
[[nodiscard]] Eigen::VectorXd gram_diagonal_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower);

}  // namespace grainsweep::stats::response
