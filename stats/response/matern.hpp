// Kernel of the response model: Matern 5/2 of one anisotropic distance (Rasmussen & Williams 2006, eq. 4.17).
//
//   C(r) = (1 + sqrt(5) r + 5/3 r^2) exp(-sqrt(5) r),   dC/d(r^2) = -5/6 (1 + sqrt(5) r) exp(-sqrt(5) r)
//
// The derivative by r^2 is finite at r = 0, so gradients need no special case there. Distances are computed from
// differences, not from scalar products, so coinciding points have exactly C = 1.
#pragma once

#include <Eigen/Core>

namespace grainsweep::stats::response {

/// Hyperparameters of a response model.
struct Hyperparameters {
    Eigen::VectorXd log_length;  ///< per feature
    double log_signal = 0;       ///< log s^2
    double log_noise = 0;        ///< log g
    Eigen::MatrixXd shear;       ///< U, upper triangular with a diagonal of 1

    [[nodiscard]] double signal() const;
    [[nodiscard]] double noise() const;
    /// Returns L^-1 U: r = |map (x - x')|.
    [[nodiscard]] Eigen::MatrixXd map() const;
};

/// Returns the points in the space where the distance is Euclidean: row i is map x_i.
[[nodiscard]] Eigen::MatrixXd mapped(const Hyperparameters& h, const Eigen::Ref<const Eigen::MatrixXd>& points);

/// Computes r^2 from one mapped point to mapped rows.
void squared_distances(const Eigen::MatrixXd& rows, const Eigen::RowVectorXd& from, Eigen::Ref<Eigen::ArrayXd> out);

/// Computes C of squared distances.
void correlations(const Eigen::Ref<const Eigen::ArrayXd>& squared, Eigen::Ref<Eigen::ArrayXd> out);

/// Returns s^2 C between mapped rows and mapped others: (rows, others).
[[nodiscard]] Eigen::MatrixXd cross_covariance(const Hyperparameters& h, const Eigen::MatrixXd& rows,
                                               const Eigen::MatrixXd& others);

/// Returns the lower half (with diagonal) of s^2 C + g I of mapped rows; the upper half is not set.
[[nodiscard]] Eigen::MatrixXd covariance(const Hyperparameters& h, const Eigen::MatrixXd& rows);

/// Computes the lower halves of C and of dC/d(r^2).
void correlations_with_slope(const Eigen::MatrixXd& rows, Eigen::MatrixXd& c, Eigen::MatrixXd& slope);

}  // namespace grainsweep::stats::response
