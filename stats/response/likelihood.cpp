#include "stats/response/likelihood.hpp"

#include "stats/response/triangular.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace grainsweep::stats::response {
namespace {

constexpr double length_spread = 1.5, noise_spread = 2, typical_noise = 0.02;

double square(double x) {
    return x * x;
}

double gaussian_part(const Eigen::VectorXd& residual, const Eigen::VectorXd& weights,
                     const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>& factor) {
    const auto n = static_cast<double>(residual.size());
    return -0.5 * residual.dot(weights) - factor.matrixLLT().diagonal().array().log().sum() -
           0.5 * n * std::log(2 * std::numbers::pi);
}

/// z - b 1 with the generalised least-squares mean b.
Eigen::VectorXd residuals(const Eigen::VectorXd& values, const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>& factor) {
    const Eigen::VectorXd ones = factor.solve(Eigen::VectorXd::Ones(values.size()));
    return values.array() - values.dot(ones) / ones.sum();
}

}  // namespace

Likelihood::Likelihood(Eigen::MatrixXd points, Eigen::VectorXd values, bool learns_map)
    : points_(std::move(points)), values_(std::move(values)), learns_map_(learns_map) {}

Eigen::Index Likelihood::parameters() const {
    const Eigen::Index d = points_.cols();
    return d + 2 + (learns_map_ ? d * (d - 1) / 2 : 0);
}

Hyperparameters Likelihood::hyperparameters(const Eigen::VectorXd& parameters) const {
    const Eigen::Index d = points_.cols();
    Hyperparameters h{parameters.head(d), parameters(d), parameters(d + 1), Eigen::MatrixXd::Identity(d, d)};
    Eigen::Index next = d + 2;
    if (learns_map_)
        for (Eigen::Index j = 0; j < d; ++j)
            for (Eigen::Index k = j + 1; k < d; ++k) h.shear(j, k) = parameters(next++);
    return h;
}

Eigen::VectorXd Likelihood::parameters(const Hyperparameters& h) const {
    const Eigen::Index d = points_.cols();
    Eigen::VectorXd row(parameters());
    row.head(d) = h.log_length;
    row(d) = h.log_signal;
    row(d + 1) = h.log_noise;
    Eigen::Index next = d + 2;
    if (learns_map_)
        for (Eigen::Index j = 0; j < d; ++j)
            for (Eigen::Index k = j + 1; k < d; ++k) row(next++) = h.shear(j, k);
    return row;
}

double Likelihood::log_prior(const Hyperparameters& h, Eigen::VectorXd* gradient) const {
    const Eigen::Index d = points_.cols();
    const double noise = (h.log_noise - std::log(typical_noise)) / noise_spread;
    double value = -0.5 * (h.log_length / length_spread).squaredNorm() - 0.5 * square(noise);
    if (gradient) {
        gradient->head(d) -= h.log_length / square(length_spread);
        (*gradient)(d + 1) -= noise / noise_spread;
    }
    Eigen::Index next = d + 2;
    if (learns_map_)
        for (Eigen::Index j = 0; j < d; ++j)
            for (Eigen::Index k = j + 1; k < d; ++k) {
                value -= 0.5 * square(h.shear(j, k));
                if (gradient) (*gradient)(next++) -= h.shear(j, k);
            }
    return value;
}

double Likelihood::value(const Eigen::VectorXd& parameters) const {
    const Hyperparameters h = hyperparameters(parameters);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(covariance(h, mapped(h, points_)));
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const Eigen::VectorXd residual = residuals(values_, factor);
    return gaussian_part(residual, factor.solve(residual), factor) + log_prior(h, nullptr);
}

double Likelihood::value(const Eigen::VectorXd& parameters, Eigen::VectorXd& gradient) const {
    const Hyperparameters h = hyperparameters(parameters);
    const Eigen::Index d = points_.cols();
    gradient = Eigen::VectorXd::Zero(parameters.size());
    Eigen::MatrixXd c, slope;
    correlations_with_slope(mapped(h, points_), c, slope);
    c.triangularView<Eigen::Lower>() *= h.signal();
    c.diagonal().array() += h.noise();
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(c);
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const Eigen::VectorXd residual = residuals(values_, factor);
    const Eigen::VectorXd a = factor.solve(residual);

    Eigen::MatrixXd inverse_factor = factor.matrixLLT();
    invert_lower(inverse_factor);
    Eigen::MatrixXd g = gram_of_lower(inverse_factor);  // K^-1
    const double trace = g.trace(), n = static_cast<double>(a.size());
    gradient(d + 1) = 0.5 * h.noise() * (a.squaredNorm() - trace);
    gradient(d) = 0.5 * (residual.dot(a) - n) - gradient(d + 1);  // s^2 C = K - g I

    // Only the lower halves of a a^T - K^-1 and of the slope are formed; the sums over i, j take them twice.
    for (Eigen::Index j = 0; j < g.cols(); ++j) {
        const Eigen::Index below = g.rows() - j - 1;
        g.col(j).tail(below) = (0.5 * h.signal() * (a(j) * a.tail(below) - g.col(j).tail(below)).array() *
                                slope.col(j).tail(below).array())
                                   .matrix();
        g(j, j) = 0;  // points do not move against themselves
    }
    const auto symmetric = g.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd sums = symmetric * Eigen::VectorXd::Ones(g.rows());
    const Eigen::MatrixXd moved = sums.asDiagonal() * points_ - symmetric * points_;
    const Eigen::MatrixXd map = h.map();
    const Eigen::MatrixXd by_map = 4 * map * (points_.transpose() * moved);
    gradient.head(d) = -(by_map.array() * map.array()).rowwise().sum();
    Eigen::Index next = d + 2;
    if (learns_map_)
        for (Eigen::Index j = 0; j < d; ++j)
            for (Eigen::Index k = j + 1; k < d; ++k) gradient(next++) = by_map(j, k) * std::exp(-h.log_length(j));
    return gaussian_part(residual, a, factor) + log_prior(h, &gradient);
}

}  // namespace grainsweep::stats::response
