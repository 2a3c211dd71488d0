#include "stats/probability_model.hpp"

#include "stats/confidence.hpp"
#include "stats/response/climb.hpp"
#include "stats/response/expectation.hpp"
#include "stats/response/fit.hpp"
#include "stats/sobol_sequence.hpp"

#include <boost/math/special_functions/owens_t.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {

using response::Expectation;
using response::Hyperparameters;
using response::Trials;

struct ProbabilityModel::State {
    Eigen::VectorXd low, high;
    Trials trials;
    Expectation found;
    ProbabilityQuality quality;
};

namespace {

constexpr double inside_by = 1e-9;  // of the box: what round-off of a feature may do
constexpr double length_prior = 1.5, signal_prior = 2;
const double typical_signal = std::log(400.0);
constexpr std::size_t places_in_search = 200, most_places = 1000, places_at_once = 1024;
constexpr std::size_t compared_starts = 8, climbed_starts = 2;
constexpr int most_looks = 30;

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

Hyperparameters hyperparameters_of(const Eigen::VectorXd& at) {
    const Eigen::Index d = at.size() - 1;
    return {at.head(d), at(d), 0, Eigen::MatrixXd::Identity(d, d)};
}

/// Log posterior density of log l and log s^2,; factors of the last look start the next.
struct EvidenceSearch {
    const Trials* trials;
    std::optional<Expectation> last = {};
    Eigen::VectorXd best = {};
    double best_value = -std::numeric_limits<double>::infinity();

    double look(const Eigen::VectorXd& at, Eigen::VectorXd* gradient) {
        auto found = response::propagate(hyperparameters_of(at), *trials, last ? &*last : nullptr);
        if (!found || !std::isfinite(found->log_evidence)) return -std::numeric_limits<double>::infinity();
        const Eigen::Index d = at.size() - 1;
        const double signal = (at(d) - typical_signal) / signal_prior;
        const double value =
            found->log_evidence - 0.5 * (at.head(d) / length_prior).squaredNorm() - 0.5 * signal * signal;
        if (gradient) {
            *gradient = response::evidence_gradient(*found);
            gradient->head(d) -= at.head(d) / (length_prior * length_prior);
            (*gradient)(d) -= signal / signal_prior;
        }
        last = std::move(found);
        if (value > best_value) best_value = value, best = at;
        return value;
    }
};

void climb_from(EvidenceSearch& search, const Eigen::VectorXd& from) {
    const Eigen::Index d = from.size() - 1;
    response::Bounds bounds{Eigen::VectorXd::Constant(d + 1, std::log(0.05)),
                            Eigen::VectorXd::Constant(d + 1, std::log(50.0))};
    bounds.low(d) = -4;
    bounds.high(d) = 8;
    (void)response::climb([&](const auto& at, auto& gradient) { return search.look(at, &gradient); }, from, bounds,
                          1e-2, most_looks);
}

/// The maximum that the best of Sobol starts lead to; none where every look is singular.
std::optional<Hyperparameters> likeliest(const Trials& trials) {
    const Eigen::Index d = trials.points.cols();
    SobolSequence sequence(static_cast<std::size_t>(d + 1));
    EvidenceSearch search{&trials};
    std::vector<std::pair<double, Eigen::VectorXd>> starts;
    for (std::size_t s = 0; s < compared_starts; ++s) {
        Eigen::VectorXd at(d + 1);
        for (Eigen::Index j = 0; j < d; ++j) at(j) = -1.5 + 3 * sequence.next_fraction();
        at(d) = 7 * sequence.next_fraction();
        const double value = search.look(at, nullptr);
        starts.emplace_back(value, std::move(at));
    }
    std::ranges::stable_sort(starts, [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t s = 0; s < climbed_starts; ++s)
        if (std::isfinite(starts[s].first)) climb_from(search, starts[s].second);
    if (!std::isfinite(search.best_value)) return std::nullopt;
    return hyperparameters_of(search.best);
}

Prediction prediction_of(double mean, double variance) {
    const double h = mean / std::sqrt(1 + variance), p = normal_cdf(h);
    const double square = p - 2 * boost::math::owens_t(h, 1 / std::sqrt(1 + 2 * variance));
    Prediction one{
        .mean = p, .mean_error = std::sqrt(std::max(square - p * p, 0.0)), .scatter = std::sqrt(p * (1 - p))};
    one.latent = Prediction::Latent{mean, std::sqrt(variance)};
    return one;
}

void assess_probability(ProbabilityModel::State& state) {
    auto& quality = state.quality;
    const auto& trials = state.trials;
    const double n = trials.count.sum(), share = trials.successes.sum() / n;
    quality.rests_on = static_cast<std::size_t>(std::lround(n));
    double sum = 0;
    for (Eigen::Index i = 0; i < trials.count.size(); ++i) {
        const double p = normal_cdf(state.found.cavity_mean(i) / std::sqrt(1 + state.found.cavity_variance(i)));
        sum += trials.successes(i) * (1 - p) * (1 - p) + (trials.count(i) - trials.successes(i)) * p * p;
    }
    quality.brier = sum / n;
    quality.brier_of_share = share * (1 - share);
    for (const double l : state.found.h.log_length) quality.lengths.push_back(std::exp(l));
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

std::vector<Prediction> ProbabilityModel::predict(Rows points) const {
    const Eigen::MatrixXd x = place_in_box(points, state_->low, state_->high);
    std::vector<Prediction> result;
    for (Eigen::Index from = 0; from < x.rows(); from += places_at_once) {
        const Eigen::MatrixXd some = x.middleRows(from, std::min<Eigen::Index>(places_at_once, x.rows() - from));
        const auto latent = response::predict(state_->found, response::mapped(state_->found.h, some));
        for (Eigen::Index i = 0; i < some.rows(); ++i) {
            result.push_back(prediction_of(latent.mean(i), latent.variance(i)));
            result.back().inside = some.row(i).minCoeff() >= -inside_by && some.row(i).maxCoeff() <= 1 + inside_by;
        }
    }
    return result;
}

std::vector<double> ProbabilityModel::probabilities(Rows points) const {
    std::vector<double> result;
    for (const auto& one : predict(points)) result.push_back(one.mean);
    return result;
}

std::vector<bool> ProbabilityModel::likely(Rows points) const {
    const Eigen::MatrixXd x = place_in_box(points, state_->low, state_->high);
    std::vector<bool> result;
    for (Eigen::Index from = 0; from < x.rows(); from += places_at_once) {
        const Eigen::MatrixXd some = x.middleRows(from, std::min<Eigen::Index>(places_at_once, x.rows() - from));
        for (const double mean : response::predict_means(state_->found, response::mapped(state_->found.h, some)))
            result.push_back(mean >= 0);
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
    Expectation start = state_->found;
    start.tau.conservativeResize(n + more);
    start.nu.conservativeResize(n + more);
    start.tau.tail(more).setZero();
    start.nu.tail(more).setZero();
    auto found = response::propagate(state_->found.h, trials, &start);
    if (!found) throw std::invalid_argument("probability model: its equations are singular");
    next->found = std::move(*found);
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
    const auto h = likeliest(searched_trials(state->trials));
    if (static_cast<std::size_t>(state->trials.count.size()) > most_places)
        state->trials = chosen_trials(state->trials, response::space_filling_choice(state->trials.points, most_places));
    auto found = h ? response::propagate(*h, state->trials) : std::nullopt;
    if (!found) return Refusal{"no model of a probability: its equations are singular in double precision"};
    state->found = std::move(*found);
    assess_probability(*state);
    return ProbabilityModel(std::move(state));
}

}  // namespace grainsweep::stats
