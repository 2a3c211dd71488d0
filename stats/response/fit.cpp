#include "stats/response/fit.hpp"

#include "stats/random.hpp"
#include "stats/response/climb.hpp"
#include "stats/response/kriging.hpp"
#include "stats/sobol_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace grainsweep::stats::response {
namespace {

constexpr std::size_t cases_of_first_search = 200, cases_for_map = 200, compared_per_start = 8, followed = 2;
constexpr int most_evaluations = 80;
constexpr double value_tolerance = 1e-3;  // of a log density: far below the differences between models

Bounds bounds(const Likelihood& likelihood) {
    const Eigen::Index d = likelihood.points().cols(), size = likelihood.parameters();
    Bounds b{Eigen::VectorXd::Constant(size, -5), Eigen::VectorXd::Constant(size, 5)};
    b.low.head(d).setConstant(std::log(0.02));
    b.high.head(d).setConstant(std::log(50.0));
    b.low(d) = -4;
    b.high(d) = 6;
    b.low(d + 1) = std::log(smallest_noise);
    b.high(d + 1) = std::log(2.0);
    return b;
}

Climbed climb_likelihood(const Likelihood& likelihood, const Eigen::VectorXd& from) {
    const Ascent density = [&](const Eigen::VectorXd& at, Eigen::VectorXd& slope) {
        return likelihood.value(at, slope);
    };
    return climb(density, from, bounds(likelihood), value_tolerance, most_evaluations);
}

std::vector<Eigen::VectorXd> starting_points(Eigen::Index d, std::size_t count) {
    const Eigen::Index size = d + 2;
    Eigen::VectorXd low = Eigen::VectorXd::Constant(size, -1.5), high = Eigen::VectorXd::Constant(size, 1.5);
    low(d) = -0.5;
    high(d) = 2;
    low(d + 1) = std::log(0.001);
    high(d + 1) = std::log(0.3);
    SobolSequence sequence(static_cast<std::size_t>(size));
    std::vector<Eigen::VectorXd> points;
    for (std::size_t s = 0; s < count; ++s) {
        Eigen::VectorXd at(size);
        for (Eigen::Index j = 0; j < size; ++j) {
            const double u = sequence.next_fraction();
            at(j) = low(j) + u * (high(j) - low(j));
        }
        points.push_back(std::move(at));
    }
    return points;
}

Likelihood likelihood_of(const Eigen::MatrixXd& points, const Eigen::VectorXd& values, std::size_t cases, bool map) {
    const auto chosen = spread_choice(points.rows(), cases);
    return {points(chosen, Eigen::all), values(chosen), map};
}

/// A place of the search and the value there.
using Maximum = std::pair<double, Eigen::VectorXd>;

/// The highest of what the best maxima lead to on more cases.
Maximum best_followed(const std::vector<Maximum>& maxima, const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                      std::size_t cases) {
    const Likelihood large = likelihood_of(points, values, cases, false);
    Maximum best{-std::numeric_limits<double>::infinity(), {}};
    std::vector<Eigen::VectorXd> climbed;
    for (const auto& [value, at] : maxima) {
        // Maxima that are one are followed once.
        const bool met = std::ranges::any_of(climbed, [&a = at](const auto& c) { return (a - c).norm() < 0.3; });
        if (met || climbed.size() == followed || !std::isfinite(value)) continue;
        climbed.push_back(at);
        Climbed found = climb_likelihood(large, at);
        if (found.value > best.first) best = {found.value, std::move(found.at)};
    }
    return best;
}

}  // namespace

std::vector<Eigen::Index> spread_choice(Eigen::Index n, std::size_t count) {
    std::vector<Eigen::Index> rows(static_cast<std::size_t>(n));
    std::iota(rows.begin(), rows.end(), Eigen::Index{0});
    if (rows.size() <= count) return rows;
    const auto order = permutation(static_cast<std::uint32_t>(n), Generator(bits_at(1, 0x726573706f6e7365ULL, 0)));
    for (std::size_t i = 0; i < count; ++i) rows[i] = static_cast<Eigen::Index>(order[i]);
    rows.resize(count);
    std::ranges::sort(rows);
    return rows;
}

std::optional<Hyperparameters> fit_lengths(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                           const FitSettings& settings) {
    const Likelihood small = likelihood_of(points, values, std::min(settings.cases, cases_of_first_search), false);
    std::vector<Maximum> starts;
    for (auto& at : starting_points(points.cols(), settings.starts * compared_per_start))
        starts.emplace_back(small.value(at), std::move(at));
    const auto better = [](const auto& a, const auto& b) { return a.first > b.first; };
    std::ranges::stable_sort(starts, better);
    starts.resize(std::max<std::size_t>(settings.starts, 1));
    for (auto& start : starts) {
        const Climbed found = climb_likelihood(small, start.second);
        start = {found.value, found.at};
    }
    std::ranges::stable_sort(starts, better);
    const auto most = std::min(settings.cases, static_cast<std::size_t>(points.rows()));
    const auto [value, at] =
        most > cases_of_first_search ? best_followed(starts, points, values, settings.cases) : starts.front();
    if (!std::isfinite(value)) return std::nullopt;
    return small.hyperparameters(at);
}

std::optional<Hyperparameters> fit_map(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                       const Hyperparameters& lengths, const FitSettings& settings) {
    const Likelihood likelihood = likelihood_of(points, values, settings.cases, true);
    const Climbed found = climb_likelihood(likelihood, likelihood.parameters(lengths));
    if (!std::isfinite(found.value)) return std::nullopt;
    return likelihood.hyperparameters(found.at);
}

std::optional<Hyperparameters> find_hyperparameters(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                                    const FitSettings& settings) {
    const auto plain = fit_lengths(points, values, settings);
    const bool always = settings.map == LearnedMap::always;
    const bool enough = static_cast<std::size_t>(values.size()) >= cases_for_map;
    const bool wanted = points.cols() >= 2 && (always || (settings.map == LearnedMap::where_better && enough));
    const auto mapped = plain && wanted ? fit_map(points, values, *plain, settings) : std::nullopt;
    const auto error = [&](const Hyperparameters& h) { return leave_one_out_rms(h, points, values, settings.cases); };
    return mapped && (always || error(*mapped) < error(*plain)) ? mapped : plain;
}

Hyperparameters follow(const Hyperparameters& found, const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                       std::size_t cases) {
    const Likelihood likelihood = likelihood_of(points, values, cases, !found.shear.isIdentity(0));
    const Climbed better = climb_likelihood(likelihood, likelihood.parameters(found));
    return std::isfinite(better.value) ? likelihood.hyperparameters(better.at) : found;
}

double leave_one_out_rms(const Hyperparameters& h, const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                         std::size_t cases) {
    const auto chosen = spread_choice(points.rows(), cases);
    const auto kriging = solve_kriging(h, points(chosen, Eigen::all), values(chosen));
    if (!kriging) return std::numeric_limits<double>::infinity();
    return std::sqrt(leave_one_out(*kriging).residual.array().square().mean());
}

std::vector<Eigen::Index> space_filling_choice(const Eigen::MatrixXd& points, std::size_t count) {
    std::vector<Eigen::Index> chosen;
    const Eigen::RowVectorXd middle = Eigen::RowVectorXd::Constant(points.cols(), 0.5);
    Eigen::ArrayXd nearest(points.rows()), from(points.rows());
    squared_distances(points, middle, from);
    Eigen::Index next = 0;
    from.minCoeff(&next);
    nearest.setConstant(std::numeric_limits<double>::infinity());
    while (chosen.size() < std::min(count, static_cast<std::size_t>(points.rows()))) {
        chosen.push_back(next);
        squared_distances(points, points.row(next), from);
        nearest = nearest.min(from);
        nearest(next) = -1;  // never again, even where points coincide
        nearest.maxCoeff(&next);
    }
    std::ranges::sort(chosen);
    return chosen;
}

}  // namespace grainsweep::stats::response
