#include "stats/probability_model.hpp"

#include "stats/confidence.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/likely_hyperparameters.hpp"

#include <boost/math/special_functions/owens_t.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {

using response::Expectation;
using response::Trials;

struct ProbabilityModel::State {
    /// The latent function under one set of hyperparameters, and the probability of these.
    struct Part {
        double weight;
        Expectation found;
    };
    Eigen::VectorXd low, high;
    Trials trials;
    std::vector<Part> parts;  ///< the likeliest first
    ProbabilityQuality quality;
};

namespace {

constexpr double inside_by = 1e-9;    // relative to the box: largest round-off of a feature
constexpr double sure_within = 1e-9;  // where the moments of a probability have too few digits
constexpr std::size_t places_in_search = 200, most_places = 1000, places_at_once = 1024;

Eigen::MatrixXd place_in_box(Rows points, const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (points.dimensions != static_cast<std::size_t>(low.size()) || points.values.size() % points.dimensions != 0)
        throw std::invalid_argument("probability model: points have another number of features");
    const Eigen::Map<const RowMajor> raw(points.values.data(), static_cast<Eigen::Index>(points.size()), low.size());
    return (raw.rowwise() - low.transpose()).array().rowwise() / (high - low).transpose().array();
}

/// Cases of equal features are trials of one place, in the order of the first of each.
Trials trials_of(const Eigen::MatrixXd& x, std::span<const double> values) {
    std::map<std::vector<double>, Eigen::Index> places;
    std::vector<Eigen::Index> first;
    std::vector<double> count, successes;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double value = values[static_cast<std::size_t>(i)];
        if (!std::isfinite(value)) continue;
        std::vector<double> row(static_cast<std::size_t>(x.cols()));
        for (Eigen::Index j = 0; j < x.cols(); ++j) row[static_cast<std::size_t>(j)] = x(i, j);
        const auto [found, is_new] = places.try_emplace(std::move(row), static_cast<Eigen::Index>(first.size()));
        if (is_new) {
            first.push_back(i);
            count.push_back(0);
            successes.push_back(0);
        }
        count[static_cast<std::size_t>(found->second)] += 1;
        successes[static_cast<std::size_t>(found->second)] += value;
    }
    const auto size = static_cast<Eigen::Index>(first.size());
    return {x(first, Eigen::all), Eigen::Map<Eigen::VectorXd>(count.data(), size),
            Eigen::Map<Eigen::VectorXd>(successes.data(), size)};
}

Trials chosen_trials(const Trials& all, const std::vector<Eigen::Index>& rows) {
    return {all.points(rows, Eigen::all), all.count(rows), all.successes(rows)};
}

/// Places for the search, half of them with the rarer outcome, where there are so many.
Trials searched_trials(const Trials& all) {
    const bool ones_are_rare = 2 * all.successes.sum() < all.count.sum();
    std::vector<Eigen::Index> rare, others;
    for (Eigen::Index i = 0; i < all.count.size(); ++i) {
        const bool has_rare = ones_are_rare ? all.successes(i) > 0 : all.successes(i) < all.count(i);
        (has_rare ? rare : others).push_back(i);
    }
    const auto some = [](const std::vector<Eigen::Index>& of, std::size_t count) {
        std::vector<Eigen::Index> rows;
        for (const auto k : response::spread_choice(std::ssize(of), count))
            rows.push_back(of[static_cast<std::size_t>(k)]);
        return rows;
    };
    auto rows =
        some(rare, std::max(places_in_search / 2, places_in_search - std::min(others.size(), places_in_search)));
    std::ranges::copy(some(others, places_in_search - rows.size()), std::back_inserter(rows));
    std::ranges::sort(rows);
    return chosen_trials(all, rows);
}

/// E Phi(f) and E Phi(f)^2 of the header.
struct TwoMoments {
    double mean = 0, square = 0;
};

TwoMoments moments_of_probability(double mean, double variance) {
    const double h = mean / std::sqrt(1 + variance), p = normal_cdf(h);
    return {p, p - 2 * boost::math::owens_t(h, 1 / std::sqrt(1 + 2 * variance))};
}

/// The normal f of these moments; its variance by bisection of Owen's T, which grows with its second argument.
Prediction::Latent latent_with(const TwoMoments& moments) {
    constexpr int halvings = 40;
    const double h = normal_quantile(moments.mean), wanted = (moments.mean - moments.square) / 2;
    double low = 0, high = 1;
    for (int step = 0; step < halvings; ++step) {
        const double middle = (low + high) / 2;
        (boost::math::owens_t(h, middle) < wanted ? low : high) = middle;
    }
    const double a = (low + high) / 2, variance = (1 / (a * a) - 1) / 2;
    return {h * std::sqrt(1 + variance), std::sqrt(variance)};
}

/// Predictions at places in the box.
std::vector<Prediction> mixed_predictions(std::span<const ProbabilityModel::State::Part> parts,
                                          const Eigen::MatrixXd& x, bool with_latent) {
    std::vector<TwoMoments> moments(static_cast<std::size_t>(x.rows()));
    response::Latent likeliest;
    for (const auto& [weight, found] : parts) {
        auto latent = response::predict(found, response::mapped(found.h, x));
        for (Eigen::Index i = 0; i < x.rows(); ++i) {
            const auto one = moments_of_probability(latent.mean(i), latent.variance(i));
            moments[static_cast<std::size_t>(i)].mean += weight * one.mean;
            moments[static_cast<std::size_t>(i)].square += weight * one.square;
        }
        if (likeliest.mean.size() == 0) likeliest = std::move(latent);
    }
    std::vector<Prediction> result;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const auto& both = moments[static_cast<std::size_t>(i)];
        const double p = both.mean;
        result.push_back({.mean = p,
                          .mean_error = std::sqrt(std::max(both.square - p * p, 0.0)),
                          .scatter = std::sqrt(p * (1 - p)),
                          .inside = x.row(i).minCoeff() >= -inside_by && x.row(i).maxCoeff() <= 1 + inside_by});
        if (!with_latent) continue;
        if (parts.size() == 1 || std::min(p, 1 - p) < sure_within)
            result.back().latent = {likeliest.mean(i), std::sqrt(likeliest.variance(i))};
        else
            result.back().latent = latent_with(both);
    }
    return result;
}

void assess_probability(ProbabilityModel::State& state) {
    auto& quality = state.quality;
    const auto& trials = state.trials;
    const auto& likeliest = state.parts.front().found;
    const double n = trials.count.sum(), share = trials.successes.sum() / n;
    quality.rests_on = static_cast<std::size_t>(std::lround(n));
    double sum = 0;
    for (Eigen::Index i = 0; i < trials.count.size(); ++i) {
        const double p = normal_cdf(likeliest.cavity_mean(i) / std::sqrt(1 + likeliest.cavity_variance(i)));
        sum += trials.successes(i) * (1 - p) * (1 - p) + (trials.count(i) - trials.successes(i)) * p * p;
    }
    quality.brier = sum / n;
    quality.brier_of_share = share * (1 - share);
    for (const double l : likeliest.h.log_length) quality.lengths.push_back(std::exp(l));
}

}  // namespace

bool only_zero_and_one(std::span<const double> values) {
    bool zero = false, one = false;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        if (value != 0 && value != 1) return false;
        (value == 0 ? zero : one) = true;
    }
    return zero && one;
}

namespace {

std::vector<Prediction> predicted_by_parts(const ProbabilityModel::State& state, Rows points, bool with_latent) {
    const Eigen::MatrixXd x = place_in_box(points, state.low, state.high);
    std::vector<Prediction> result;
    for (Eigen::Index from = 0; from < x.rows(); from += places_at_once) {
        const Eigen::MatrixXd some = x.middleRows(from, std::min<Eigen::Index>(places_at_once, x.rows() - from));
        std::ranges::move(mixed_predictions(state.parts, some, with_latent), std::back_inserter(result));
    }
    return result;
}

}  // namespace

std::vector<Prediction> ProbabilityModel::predict(Rows points) const {
    return predicted_by_parts(*state_, points, true);
}

std::vector<Prediction> ProbabilityModel::with_errors(Rows points) const {
    return predicted_by_parts(*state_, points, false);
}

std::vector<double> ProbabilityModel::probabilities(Rows points) const {
    std::vector<double> result;
    for (const auto& one : with_errors(points)) result.push_back(one.mean);
    return result;
}

std::vector<bool> ProbabilityModel::likely(Rows points) const {
    const Eigen::MatrixXd x = place_in_box(points, state_->low, state_->high);
    std::vector<bool> result;
    for (Eigen::Index from = 0; from < x.rows(); from += places_at_once) {
        const Eigen::MatrixXd some = x.middleRows(from, std::min<Eigen::Index>(places_at_once, x.rows() - from));
        const auto& found = state_->parts.front().found;
        const Eigen::VectorXd means = response::predict_means(found, response::mapped(found.h, some));
        for (const double mean : means) result.push_back(mean >= 0);
    }
    return result;
}

ProbabilityModel ProbabilityModel::with_cases(Rows points, std::span<const double> values) const {
    const Eigen::MatrixXd x = place_in_box(points, state_->low, state_->high);
    if (static_cast<std::size_t>(x.rows()) != values.size() || !x.allFinite())
        throw std::invalid_argument("probability model: an added case is no row with its value");
    auto next = std::make_shared<State>(*state_);
    auto& trials = next->trials;
    const Eigen::Index n = trials.count.size(), more = x.rows();
    trials.points.conservativeResize(n + more, Eigen::NoChange);
    trials.points.bottomRows(more) = x;
    trials.count.conservativeResize(n + more);
    trials.count.tail(more).setOnes();
    trials.successes.conservativeResize(n + more);
    for (Eigen::Index i = 0; i < more; ++i)
        trials.successes(n + i) = std::clamp(values[static_cast<std::size_t>(i)], 0.0, 1.0);
    for (auto& part : next->parts) {
        Expectation start = part.found;
        start.tau.conservativeResize(n + more);
        start.nu.conservativeResize(n + more);
        start.tau.tail(more).setZero();
        start.nu.tail(more).setZero();
        auto found = response::propagate(part.found.h, trials, &start);
        if (!found) throw std::invalid_argument("probability model: its equations are singular");
        part.found = std::move(*found);
    }
    next->quality.cases += values.size();
    next->quality.rests_on += values.size();
    return ProbabilityModel(std::move(next));
}

const ProbabilityQuality& ProbabilityModel::quality() const {
    return state_->quality;
}

std::size_t ProbabilityModel::dimensions() const {
    return static_cast<std::size_t>(state_->low.size());
}

std::variant<ProbabilityModel, Refusal> fit_probability(Rows points, std::span<const double> values,
                                                        std::span<const double> low, std::span<const double> high) {
    const auto d = static_cast<Eigen::Index>(points.dimensions);
    if (d == 0 || points.values.size() != points.dimensions * values.size() || std::ssize(low) != d ||
        std::ssize(high) != d)
        throw std::invalid_argument("probability model: one value is needed for each row, and a box");
    if (!std::ranges::all_of(points.values, [](double x) { return std::isfinite(x); }))
        return Refusal{"no model of a probability: a feature of a case is not a finite number"};
    auto state = std::make_shared<ProbabilityModel::State>();
    state->low = Eigen::Map<const Eigen::VectorXd>(low.data(), d);
    state->high = Eigen::Map<const Eigen::VectorXd>(high.data(), d);
    if (!((state->high - state->low).array() > 0).all())
        throw std::invalid_argument("probability model: the box of a feature is empty");
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        if (value != 0 && value != 1) throw std::invalid_argument("probability model: a value is neither 0 nor 1");
        ++state->quality.cases;
        if (value == 1) ++state->quality.ones;
    }
    if (state->quality.cases < 2) return Refusal{"no model of a probability: fewer than two cases"};
    state->trials = trials_of(place_in_box(points, state->low, state->high), values);
    const bool few = static_cast<std::size_t>(state->trials.count.size()) <= places_in_search;
    const auto likely = response::likely_hyperparameters(
        searched_trials(state->trials), few ? response::Wanted::places_about_it : response::Wanted::maximum);
    if (static_cast<std::size_t>(state->trials.count.size()) > most_places)
        state->trials = chosen_trials(state->trials, response::space_filling_choice(state->trials.points, most_places));
    for (const auto& [weight, h] : likely)
        if (auto found = response::propagate(h, state->trials)) state->parts.push_back({weight, std::move(*found)});
    if (state->parts.size() != likely.size() || likely.empty())
        return Refusal{"no model of a probability: its equations are singular in double precision"};
    assess_probability(*state);
    return ProbabilityModel(std::move(state));
}

}  // namespace grainsweep::stats
