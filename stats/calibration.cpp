#include "stats/calibration.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainsweep::stats {
namespace {

constexpr std::size_t second_largest_above = 5;

double squared(double x) {
    return x * x;
}

double own_variance(const Target& target) {
    return squared(target.measured_error) + squared(target.discrepancy);
}

/// Of the model and of the runs behind the measurement: both rest on few cases, and are Student's.
double predicted_variance(const Target& target, const Prediction& p) {
    const double runs = target.replicates > 0 ? squared(p.scatter) / static_cast<double>(target.replicates) : 0;
    const double student = std::isfinite(p.freedom) ? p.freedom / std::max(p.freedom - 2, 1.0) : 1;
    return student * (squared(p.mean_error) + runs);
}

void check_predictions(std::span<const Target> targets, std::span<const std::vector<Prediction>> predictions) {
    if (targets.empty() || targets.size() != predictions.size())
        throw std::invalid_argument("calibration: one prediction is needed for each target");
    for (const auto& row : predictions)
        if (row.size() != predictions.front().size())
            throw std::invalid_argument("calibration: targets are predicted at different numbers of points");
}

}  // namespace

std::vector<std::vector<double>> implausibilities(std::span<const Target> targets,
                                                  std::span<const std::vector<Prediction>> predictions) {
    check_predictions(targets, predictions);
    std::vector<std::vector<double>> all;
    for (std::size_t k = 0; k < targets.size(); ++k) {
        std::vector<double> row;
        for (const Prediction& p : predictions[k]) {
            const double variance = own_variance(targets[k]) + predicted_variance(targets[k], p);
            if (!(variance > 0)) throw std::invalid_argument("calibration: a target without any error");
            row.push_back(std::abs(targets[k].value - p.mean) / std::sqrt(variance));
        }
        all.push_back(std::move(row));
    }
    return all;
}

std::vector<double> deciding_implausibility(std::span<const std::vector<double>> implausibilities) {
    std::vector<double> deciding;
    const std::size_t place = implausibilities.size() > second_largest_above ? 1 : 0;
    std::vector<double> here(implausibilities.size());
    for (std::size_t i = 0; !implausibilities.empty() && i < implausibilities.front().size(); ++i) {
        for (std::size_t k = 0; k < here.size(); ++k) here[k] = implausibilities[k][i];
        std::ranges::sort(here, std::ranges::greater{});
        deciding.push_back(here[place]);
    }
    return deciding;
}

std::vector<double> log_likelihood(std::span<const Target> targets,
                                   std::span<const std::vector<Prediction>> predictions,
                                   std::span<const double> covariance) {
    check_predictions(targets, predictions);
    const auto m = static_cast<Eigen::Index>(targets.size());
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(m, m);
    if (covariance.empty())
        for (Eigen::Index k = 0; k < m; ++k) own(k, k) = own_variance(targets[static_cast<std::size_t>(k)]);
    else if (covariance.size() == targets.size() * targets.size())
        own = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), m, m);
    else
        throw std::invalid_argument("calibration: the covariance has another number of targets");
    std::vector<double> result;
    for (std::size_t i = 0; i < predictions.front().size(); ++i) {
        Eigen::MatrixXd v = own;
        Eigen::VectorXd r(m);
        for (Eigen::Index k = 0; k < m; ++k) {
            const Target& target = targets[static_cast<std::size_t>(k)];
            const Prediction& p = predictions[static_cast<std::size_t>(k)][i];
            v(k, k) += predicted_variance(target, p);
            r(k) = target.value - p.mean;
        }
        const Eigen::LLT<Eigen::MatrixXd> factor(v);
        if (factor.info() != Eigen::Success)
            throw std::invalid_argument("calibration: the covariance of the targets is not positive definite");
        result.push_back(-0.5 * r.dot(factor.solve(r)) - factor.matrixLLT().diagonal().array().log().sum());
    }
    return result;
}

double beyond_what_was_reached(const Target& target, std::span<const double> responses) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double y : responses) {
        if (!std::isfinite(y)) continue;
        low = std::min(low, y);
        high = std::max(high, y);
    }
    const double beyond = std::max({low - target.value, target.value - high, 0.0});
    return beyond == 0 ? 0 : beyond / std::sqrt(own_variance(target));
}

}  // namespace grainsweep::stats
