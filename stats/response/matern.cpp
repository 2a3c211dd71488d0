#include "stats/response/matern.hpp"

#include <cmath>

namespace grainsweep::stats::response {
namespace {

constexpr double root_five = 2.23606797749978969641;

}  // namespace

double Hyperparameters::signal() const {
    return std::exp(log_signal);
}

double Hyperparameters::noise() const {
    return std::exp(log_noise);
}

Eigen::MatrixXd Hyperparameters::map() const {
    return (-log_length.array()).exp().matrix().asDiagonal() * shear;
}

Eigen::MatrixXd mapped(const Hyperparameters& h, const Eigen::Ref<const Eigen::MatrixXd>& points) {
    return points * h.map().transpose();
}

void squared_distances(const Eigen::MatrixXd& rows, const Eigen::RowVectorXd& from, Eigen::Ref<Eigen::ArrayXd> out) {
    out.setZero();
    for (Eigen::Index j = 0; j < rows.cols(); ++j) out += (rows.col(j).array() - from(j)).square();
}

void correlations(const Eigen::Ref<const Eigen::ArrayXd>& squared, Eigen::Ref<Eigen::ArrayXd> out) {
    out = root_five * squared.sqrt();
    out = (1 + out + 5.0 / 3 * squared) * (-out).exp();
}

Eigen::MatrixXd cross_covariance(const Hyperparameters& h, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& others) {
    Eigen::MatrixXd k(rows.rows(), others.rows());
    Eigen::ArrayXd squared(rows.rows());
    for (Eigen::Index i = 0; i < others.rows(); ++i) {
        squared_distances(rows, others.row(i), squared);
        correlations(squared, k.col(i).array());
    }
    k *= h.signal();
    return k;
}

Eigen::MatrixXd covariance(const Hyperparameters& h, const Eigen::MatrixXd& rows) {
    const Eigen::Index n = rows.rows();
    Eigen::MatrixXd k(n, n);
    Eigen::ArrayXd squared(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index below = n - i;
        squared.head(below).setZero();
        for (Eigen::Index j = 0; j < rows.cols(); ++j)
            squared.head(below) += (rows.col(j).tail(below).array() - rows(i, j)).square();
        correlations(squared.head(below), k.col(i).tail(below).array());
    }
    k.triangularView<Eigen::Lower>() *= h.signal();
    k.diagonal().array() += h.noise();
    return k;
}

void correlations_with_slope(const Eigen::MatrixXd& rows, Eigen::MatrixXd& c, Eigen::MatrixXd& slope) {
    const Eigen::Index n = rows.rows();
    c.resize(n, n);
    slope.resize(n, n);
    Eigen::ArrayXd squared(n), scaled(n), decay(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index below = n - i;
        auto r2 = squared.head(below);
        auto r = scaled.head(below);
        auto e = decay.head(below);
        r2.setZero();
        for (Eigen::Index j = 0; j < rows.cols(); ++j) r2 += (rows.col(j).tail(below).array() - rows(i, j)).square();
        r = root_five * r2.sqrt();
        e = (-r).exp();
        c.col(i).tail(below).array() = (1 + r + 5.0 / 3 * r2) * e;
        slope.col(i).tail(below).array() = -5.0 / 6 * (1 + r) * e;
    }
}

}  // namespace grainsweep::stats::response
