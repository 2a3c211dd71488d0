// Inverses by blocks, so that nearly all work is in matrix products: n^3/3 multiplications and additions each, as
// many as the structure leaves (Golub & Van Loan 2013, section 3.1; LAPACK's trtri and lauum).
#pragma once

#include <Eigen/Core>

namespace grainsweep::stats::response {

/// L <- L^-1 for a lower triangular matrix; the upper half is neither read nor written.
void invert_lower(Eigen::Ref<Eigen::MatrixXd> lower);

/// The whole symmetric matrix M^T M of a lower triangular M = L^-1, which is K^-1 for K = L L^T.
[[nodiscard]] Eigen::MatrixXd gram_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower);

/// The diagonal of M^T M.
[[nodiscard]] Eigen::VectorXd gram_diagonal_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower);

}  // namespace grainsweep::stats::response
