// Prediction with given hyperparameters as one symmetric system (universal kriging with a constant mean; Cressie 1993,
// section 3.4).
//
//   [K 1; 1^T 0] [a; b] = [z; 0]      mean(x) = b + k(x)^T a,   k_i(x) = s^2 C(|M (x - x_i)|)
//   var(x) = s^2 - k^T K^-1 k + (1 - 1^T K^-1 k)^2 / (1^T K^-1 1)       of the mean; a single run adds the noise g
//
// Leave-out predictions (Dubrule 1983, Math. Geol. 15, 687) keep the hyperparameters and estimate the mean anew. The
// upper left block of the inverse of the system is B = K^-1 - K^-1 1 1^T K^-1/(1^T K^-1 1), and without the cases S
//
//   z_S - prediction = B_SS^-1 (B z)_S,   its covariance B_SS^-1 (noise included),   B z = a
//   a^(-S) = a - B(:, S) B_SS^-1 a_S,     b^(-S) = b - c_S^T B_SS^-1 a_S,   c = K^-1 1/(1^T K^-1 1)
#pragma once

#include "stats/response/matern.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace grainsweep::stats::response {

struct Kriging {
    Hyperparameters h;
    Eigen::MatrixXd points;  ///< mapped (n, d)
    Eigen::VectorXd values;
    Eigen::MatrixXd factor;        ///< L of K = L L^T, lower half
    Eigen::VectorXd weights;       ///< a
    Eigen::VectorXd mean_weights;  ///< c
    double mean = 0;               ///< b
    double precision = 0;          ///< 1^T K^-1 1

    [[nodiscard]] Eigen::Index size() const { return values.size(); }
};

/// Solves the system. Empty if K is singular in double precision.
[[nodiscard]] std::optional<Kriging> solve_kriging(const Hyperparameters& h, const Eigen::MatrixXd& points,
                                                   const Eigen::VectorXd& values);

/// Returns the system with rows appended; n^2 m operations.
[[nodiscard]] std::optional<Kriging> extend_kriging(const Kriging& old, const Eigen::MatrixXd& points,
                                                    const Eigen::VectorXd& values);

struct KrigingPrediction {
    Eigen::VectorXd mean;
    Eigen::VectorXd variance;  ///< of the mean
};

/// Returns predictions at mapped points (m, d).
[[nodiscard]] KrigingPrediction predict(const Kriging& model, const Eigen::MatrixXd& at);
[[nodiscard]] Eigen::VectorXd predict_means(const Kriging& model, const Eigen::MatrixXd& at);

struct LeftOut {
    Eigen::VectorXd residual;  ///< observed minus predicted
    Eigen::VectorXd variance;  ///< of the residual, noise included
};

/// Weights and means of several models, each without some of the cases: mean_s(x) = means(s) + k(x)^T weights.col(s).
struct FoldWeights {
    Eigen::MatrixXd weights;  ///< (n, folds); 0 for cases that a fold leaves out
    Eigen::RowVectorXd means;

    /// Returns the means at mapped points: (m, folds).
    [[nodiscard]] Eigen::MatrixXd predict(const Kriging& model, const Eigen::MatrixXd& at) const;
};

/// Returns K^-1 without what the estimated mean takes: B = K^-1 - p c c^T, p the precision of the mean and c its
/// weights; n^3/3 operations.
[[nodiscard]] Eigen::MatrixXd inverse_of(const Kriging& model);

/// Returns the weights of every fold s without the cases left_out[s], with the same hyperparameters. `inverse`:
/// inverse_of(model); n^2 operations per fold.
[[nodiscard]] FoldWeights leave_folds_out(const Kriging& model, const Eigen::MatrixXd& inverse,
                                          const std::vector<std::vector<Eigen::Index>>& left_out);

/// Returns the residual of every case, predicted from all others.
[[nodiscard]] LeftOut leave_one_out(const Kriging& model);

}  // namespace grainsweep::stats::response
