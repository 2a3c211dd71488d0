#include "stats/response/likely_hyperparameters.hpp"

#include "stats/response/climb.hpp"
#include "stats/sobol_sequence.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace grainsweep::stats::response {
namespace {

constexpr double length_prior = 1.5, signal_prior = 2;
const double typical_signal = std::log(400.0);
constexpr std::size_t compared_starts = 8, climbed_starts = 2;
constexpr int most_looks_of_climb = 30;
constexpr double shortest_length = 0.05, longest_length = 50, least_log_signal = -4, most_log_signal = 8;
constexpr double step_of_curvature = 0.1, least_curvature = 0.25, most_above_normal = 2;

Hyperparameters hyperparameters_of(const Eigen::VectorXd& theta) {
    const Eigen::Index d = theta.size() - 1;
    return {theta.head(d), theta(d), 0, Eigen::MatrixXd::Identity(d, d)};
}

/// Looks at the log density of the header; the factors of a look start the next one.
struct EvidenceSearch {
    const Trials* trials;
    std::optional<Expectation> last = {};
    Eigen::VectorXd best = {};
    double best_value = -std::numeric_limits<double>::infinity();

    double look(const Eigen::VectorXd& theta, Eigen::VectorXd* gradient) {
        auto found = propagate(hyperparameters_of(theta), *trials, last ? &*last : nullptr);
        if (!found || !std::isfinite(found->log_evidence)) return -std::numeric_limits<double>::infinity();
        const Eigen::Index d = theta.size() - 1;
        const double signal = (theta(d) - typical_signal) / signal_prior;
        const double value =
            found->log_evidence - 0.5 * (theta.head(d) / length_prior).squaredNorm() - 0.5 * signal * signal;
        if (gradient) {
            *gradient = evidence_gradient(*found);
            gradient->head(d) -= theta.head(d) / (length_prior * length_prior);
            (*gradient)(d) -= signal / signal_prior;
        }
        last = std::move(found);
        if (value > best_value) best_value = value, best = theta;
        return value;
    }
};

Bounds bounds_of(Eigen::Index d) {
    Bounds bounds{Eigen::VectorXd::Constant(d + 1, std::log(shortest_length)),
                  Eigen::VectorXd::Constant(d + 1, std::log(longest_length))};
    bounds.low(d) = least_log_signal;
    bounds.high(d) = most_log_signal;
    return bounds;
}

/// The search ends with its best at the maximum.
void find_maximum(EvidenceSearch& search, Eigen::Index d) {
    SobolSequence sequence(static_cast<std::size_t>(d + 1));
    std::vector<std::pair<double, Eigen::VectorXd>> starts;
    for (std::size_t s = 0; s < compared_starts; ++s) {
        Eigen::VectorXd theta(d + 1);
        for (Eigen::Index j = 0; j < d; ++j) theta(j) = -1.5 + 3 * sequence.next_fraction();
        theta(d) = 7 * sequence.next_fraction();
        const double value = search.look(theta, nullptr);
        starts.emplace_back(value, std::move(theta));
    }
    std::ranges::stable_sort(starts, [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t s = 0; s < climbed_starts; ++s)
        if (std::isfinite(starts[s].first))
            (void)climb([&](const auto& theta, auto& gradient) { return search.look(theta, &gradient); },
                        starts[s].second, bounds_of(d), 1e-2, most_looks_of_climb);
}

/// Axes of the curvature at the maximum, each as long as a standard deviation along it.
Eigen::MatrixXd axes_about(EvidenceSearch& search, const Eigen::VectorXd& top) {
    const Eigen::Index size = top.size();
    Eigen::MatrixXd curvature(size, size);
    for (Eigen::Index j = 0; j < size; ++j) {
        Eigen::VectorXd up = top, down = top, above(size), below(size);
        up(j) += step_of_curvature;
        down(j) -= step_of_curvature;
        if (!std::isfinite(search.look(up, &above)) || !std::isfinite(search.look(down, &below)))
            above = -step_of_curvature * Eigen::VectorXd::Unit(size, j), below = -above;
        curvature.col(j) = (below - above) / (2 * step_of_curvature);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver((curvature + curvature.transpose()) / 2);
    const Eigen::VectorXd widths = solver.eigenvalues().cwiseMax(least_curvature).cwiseSqrt().cwiseInverse();
    return solver.eigenvectors() * widths.asDiagonal();
}

std::vector<LikelyHyperparameters> places_about(EvidenceSearch& search) {
    const Eigen::VectorXd top = search.best;
    const double height = search.best_value;
    const auto size = static_cast<double>(top.size()), squared = size + 2;
    const auto bounds = bounds_of(top.size() - 1);
    const Eigen::MatrixXd axes = std::sqrt(squared) * axes_about(search, top);
    std::vector<LikelyHyperparameters> places = {{2 / squared, hyperparameters_of(top)}};
    for (const auto& axis : axes.colwise())
        for (const double side : {-1.0, 1.0}) {
            const Eigen::VectorXd theta = (top + side * axis).cwiseMax(bounds.low).cwiseMin(bounds.high);
            const double above_normal = search.look(theta, nullptr) - height + squared / 2;
            if (!std::isfinite(above_normal)) continue;
            const double weight = std::exp(std::min(above_normal, most_above_normal)) / (2 * squared);
            places.push_back({weight, hyperparameters_of(theta)});
        }
    double sum = 0;
    for (const auto& one : places) sum += one.weight;
    for (auto& one : places) one.weight /= sum;
    return places;
}

}  // namespace

std::vector<LikelyHyperparameters> likely_hyperparameters(const Trials& trials, Wanted wanted) {
    EvidenceSearch search{&trials};
    find_maximum(search, trials.points.cols());
    if (!std::isfinite(search.best_value)) return {};
    if (wanted == Wanted::maximum) return {{1, hyperparameters_of(search.best)}};
    return places_about(search);
}

}  // namespace grainsweep::stats::response
