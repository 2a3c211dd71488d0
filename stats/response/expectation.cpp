#include "stats/response/expectation.hpp"

#include "stats/response/triangular.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::stats::response {
namespace {

constexpr double mean_variance = 4;  // c^2
constexpr int most_rounds = 100, most_newton_steps = 50;
constexpr double settled = 1e-5;
constexpr double first_step = 0.8, least_step = 0.1;
constexpr double reach = 16, node_spacing = 0.4, finest = 0.5;  // in widths of the mode; in f, whose Phi turns within 1

/// phi(f)/Phi(f)
double hazard(double f) {
    return std::exp(-0.5 * f * f - 0.5 * std::log(2 * std::numbers::pi) - log_normal_cdf(f));
}

/// What is seen at one place: logarithm of its factor with two derivatives.
struct Seen {
    double successes, failures;

    [[nodiscard]] double log_factor(double f) const {
        double sum = 0;
        if (successes > 0) sum += successes * log_normal_cdf(f);
        if (failures > 0) sum += failures * log_normal_cdf(-f);
        return sum;
    }
    [[nodiscard]] double slope(double f) const {
        return (successes > 0 ? successes * hazard(f) : 0) - (failures > 0 ? failures * hazard(-f) : 0);
    }
    /// Minus the second derivative (eq. 3.16).
    [[nodiscard]] double curvature(double f) const {
        const double up = successes > 0 ? hazard(f) : 0, down = failures > 0 ? hazard(-f) : 0;
        return successes * up * (up + f) + failures * down * (down - f);
    }
};

struct Moments {
    double log_size = 0, mean = 0, variance = 1;
};

/// Of N(f | mean, variance) times Phi(sign f), in closed form (eq. 3.58).
Moments moments_of_one(double sign, double mean, double variance) {
    const double root = std::sqrt(1 + variance), z = sign * mean / root, h = hazard(z);
    return {log_normal_cdf(z), mean + sign * variance * h / root,
            variance - variance * variance * h * (z + h) / (1 + variance)};
}

/// Of N(f | mean, variance) times the factor (eq. 3.57).
Moments moments_of(const Seen& seen, double mean, double variance) {
    if (seen.successes + seen.failures == 1 && (seen.successes == 0 || seen.failures == 0))
        return moments_of_one(seen.successes - seen.failures, mean, variance);
    double mode = mean;
    for (int step = 0; step < most_newton_steps; ++step) {
        const double move =
            (seen.slope(mode) - (mode - mean) / variance) / (std::max(seen.curvature(mode), 0.0) + 1 / variance);
        mode += move;
        if (std::abs(move) < 1e-8) break;
    }
    const double width = 1 / std::sqrt(std::max(seen.curvature(mode), 0.0) + 1 / variance);
    const auto log_density = [&](double f) { return seen.log_factor(f) - 0.5 * (f - mean) * (f - mean) / variance; };
    const double top = log_density(mode);
    double sum = 0, first = 0, second = 0;
    const double spacing = std::min(node_spacing, finest / width);
    const int each_side = static_cast<int>(std::ceil(reach / spacing));
    for (int k = -each_side; k <= each_side; ++k) {
        const double t = spacing * k, weight = std::exp(log_density(mode + width * t) - top);
        sum += weight;
        first += weight * t;
        second += weight * t * t;
    }
    first /= sum;
    second /= sum;
    const double size = sum * spacing * width / std::sqrt(2 * std::numbers::pi * variance);
    return {top + std::log(size), mode + width * first, width * width * (second - first * first)};
}

/// Posterior of the factors as they are; false where B is singular.
struct Round {
    Eigen::VectorXd root, mean, variance;  ///< T^1/2, marginals of f

    bool solve(Expectation& at, const Eigen::MatrixXd& k) {
        root = at.tau.cwiseSqrt();
        Eigen::MatrixXd b = root.asDiagonal() * k * root.asDiagonal();
        b.diagonal().array() += 1;
        const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(b);
        if (factor.info() != Eigen::Success) return false;
        at.factor = factor.matrixLLT();
        const auto lower = at.factor.triangularView<Eigen::Lower>();
        const Eigen::MatrixXd v = lower.solve(root.asDiagonal() * k);
        variance = k.diagonal() - v.colwise().squaredNorm().transpose();
        const Eigen::VectorXd along = k * at.nu;
        at.weights = at.nu - root.asDiagonal() * factor.solve(root.asDiagonal() * along);
        mean = k * at.weights;
        return mean.allFinite() && variance.minCoeff() > 0;
    }
};

/// Cavities, and the factors that match the moments; sum of the log sizes.
double renewed(Expectation& at, const Round& round, const Trials& trials, Eigen::VectorXd& tau, Eigen::VectorXd& nu) {
    double log_sizes = 0;
    for (Eigen::Index i = 0; i < tau.size(); ++i) {
        const double precision = std::max(1 / round.variance(i) - at.tau(i), 1e-10);
        const double shift = round.mean(i) / round.variance(i) - at.nu(i);
        at.cavity_variance(i) = 1 / precision;
        at.cavity_mean(i) = shift / precision;
        const auto m = moments_of({trials.successes(i), trials.count(i) - trials.successes(i)}, at.cavity_mean(i),
                                  at.cavity_variance(i));
        tau(i) = std::max(1 / m.variance - precision, 0.0);
        nu(i) = m.mean * (tau(i) + precision) - shift;
        log_sizes += m.log_size;
    }
    return log_sizes;
}

/// Eq. 3.65, by 3.73 and 3.74.
double evidence(const Expectation& at, const Round& round, double log_sizes) {
    const Eigen::ArrayXd tau = at.tau, nu = at.nu, cavity = at.cavity_variance.array().inverse(),
                         mu = at.cavity_mean.array();
    return log_sizes + 0.5 * (1 + tau / cavity).log().sum() - at.factor.diagonal().array().log().sum() +
           0.5 * (nu * round.mean.array()).sum() - 0.5 * (nu.square() / (tau + cavity)).sum() +
           0.5 * (mu * cavity * (tau * mu - 2 * nu) / (tau + cavity)).sum();
}

Eigen::MatrixXd with_mean(Eigen::MatrixXd k) {
    k.array() += mean_variance;
    return k;
}

}  // namespace

double log_normal_cdf(double f) {
    if (f > -20) return std::log(0.5 * std::erfc(-f / std::numbers::sqrt2));
    const double q = 1 / (f * f);  // Abramowitz & Stegun 1964, eq. 26.2.12
    return -0.5 * f * f - std::log(-f * std::sqrt(2 * std::numbers::pi)) + std::log1p(-q * (1 - 3 * q * (1 - 5 * q)));
}

std::optional<Expectation> propagate(const Hyperparameters& h, const Trials& trials, const Expectation* before) {
    const Eigen::Index n = trials.points.rows();
    Expectation at;
    at.h = h;
    at.points = mapped(h, trials.points);
    const Eigen::MatrixXd k = with_mean(cross_covariance(h, at.points, at.points));
    const bool follows = before != nullptr && before->tau.size() == n;
    at.tau = follows ? before->tau : Eigen::VectorXd::Zero(n);
    at.nu = follows ? before->nu : Eigen::VectorXd::Zero(n);
    at.cavity_mean.resize(n);
    at.cavity_variance.resize(n);
    Eigen::VectorXd tau(n), nu(n), last;
    double step = first_step, moved_before = std::numeric_limits<double>::infinity();
    for (int count = 0; count < most_rounds; ++count) {
        Round round;
        if (!round.solve(at, k)) return std::nullopt;
        const double log_sizes = renewed(at, round, trials, tau, nu);
        at.log_evidence = evidence(at, round, log_sizes);
        if (last.size() == n) {
            const double moved = ((round.mean - last).array() / round.variance.array().sqrt()).abs().maxCoeff();
            if (moved < settled) break;
            if (moved > moved_before) step = std::max(0.6 * step, least_step);
            moved_before = moved;
        }
        last = round.mean;
        if (count + 1 == most_rounds) break;
        at.tau += step * (tau - at.tau);
        at.nu += step * (nu - at.nu);
    }
    return at;
}

Eigen::VectorXd evidence_gradient(const Expectation& found) {
    const Eigen::Index n = found.points.rows(), d = found.points.cols();
    Eigen::MatrixXd c, slope;
    correlations_with_slope(found.points, c, slope);
    Eigen::MatrixXd inverse = found.factor;
    invert_lower(inverse);
    const Eigen::VectorXd root = found.tau.cwiseSqrt();
    Eigen::MatrixXd g = root.asDiagonal() * gram_of_lower(inverse) * root.asDiagonal();
    g = 0.5 * (found.weights * found.weights.transpose() - g);  // half of b b^T - R of eq. 5.27
    Eigen::VectorXd gradient(d + 1);
    const double signal = found.h.signal();
    double by_signal = 0;
    Eigen::VectorXd by_length = Eigen::VectorXd::Zero(d);
    for (Eigen::Index i = 0; i < n; ++i) {
        by_signal += g(i, i) * c(i, i);
        const Eigen::Index below = n - i - 1;
        by_signal += 2 * g.col(i).tail(below).dot(c.col(i).tail(below));
        const Eigen::ArrayXd weight = g.col(i).tail(below).array() * slope.col(i).tail(below).array();
        for (Eigen::Index j = 0; j < d; ++j)
            by_length(j) += (weight * (found.points.col(j).tail(below).array() - found.points(i, j)).square()).sum();
    }
    gradient.head(d) = -4 * signal * by_length;  // both halves, and d r^2/d log l = -2 (x - x')^2/l^2
    gradient(d) = signal * by_signal;
    return gradient;
}

Eigen::VectorXd predict_means(const Expectation& found, const Eigen::MatrixXd& at) {
    return with_mean(cross_covariance(found.h, found.points, at)).transpose() * found.weights;
}

Latent predict(const Expectation& found, const Eigen::MatrixXd& at) {
    const Eigen::MatrixXd k = with_mean(cross_covariance(found.h, found.points, at));
    const Eigen::MatrixXd v = found.factor.triangularView<Eigen::Lower>().solve(found.tau.cwiseSqrt().asDiagonal() * k);
    const double whole = found.h.signal() + mean_variance;
    return {k.transpose() * found.weights, (whole - v.colwise().squaredNorm().transpose().array()).max(1e-12).matrix()};
}

}  // namespace grainsweep::stats::response
