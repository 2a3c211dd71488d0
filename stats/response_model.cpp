#include "stats/response_model.hpp"

#include "stats/confidence.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/state.hpp"
#include "stats/spread.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

using response::Kriging;

constexpr double outside_by = 1e-9;           // relative to the box: largest round-off of a feature
constexpr double worth_a_logarithm = 2.5;     // largest value over the least
constexpr double kept_below = 0.97;           // of the error without it
constexpr std::size_t repeats_that_show = 3;  // settings with one value each: no scatter
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Eigen::VectorXd edges(const std::vector<double>& given, std::size_t d, double otherwise) {
    if (given.empty()) return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(d), otherwise);
    if (given.size() != d) throw std::invalid_argument("response model: the box has another number of features");
    return Eigen::Map<const Eigen::VectorXd>(given.data(), static_cast<Eigen::Index>(d));
}

void check_sizes(Rows points, std::size_t values) {
    if (points.dimensions == 0 || points.values.size() != points.dimensions * values)
        throw std::invalid_argument("response model: " + std::to_string(points.values.size()) + " numbers are not " +
                                    std::to_string(values) + " rows of " + std::to_string(points.dimensions));
}

bool all_finite(std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

/// Reasons to refuse that need no model. `used`: rows with a finite value.
std::optional<Refusal> reason_to_refuse(Rows points, std::span<const double> values,
                                        const std::vector<std::size_t>& used) {
    const std::size_t n = used.size(), least = std::max<std::size_t>(12, 4 * (points.dimensions + 1));
    if (!all_finite(points.values)) return Refusal{"no response model: a feature of a case is not a finite number"};
    if (n < least)
        return Refusal{"no response model: too few cases, " + std::to_string(n) + " with a value where " +
                       std::to_string(points.dimensions) + " features need at least " + std::to_string(least)};
    if (const auto reason = reason_against_powers(values, 2); !reason.empty())
        return Refusal{"no response model: " + reason};
    std::map<double, std::size_t> counts;
    for (const std::size_t i : used) ++counts[values[i]];
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    const double reach = std::max(std::abs(counts.begin()->first), std::abs(counts.rbegin()->first));
    if (counts.rbegin()->first - counts.begin()->first <= 1e-12 * reach)
        return Refusal{"no response model: the response is constant (" + shown(most->first) + " in all " +
                       std::to_string(n) + " cases)"};
    if (2 * most->second >= n)
        return Refusal{"no response model: " + std::to_string(most->second) + " of " + std::to_string(n) +
                       " responses equal " + shown(most->first) + ", half or more"};
    return std::nullopt;
}

/// Half-width of a 95 % interval in standard errors.
double half_width_factor(double freedom) {
    if (!std::isfinite(freedom)) return 1.959963984540054;
    return student_quantile(freedom, 0.975);
}

/// Sets how z stands for the responses y, and returns it.
Eigen::VectorXd standardise(ResponseModel::State& state, const Eigen::VectorXd& y, bool logarithm) {
    Eigen::ArrayXd raw = y;
    if (logarithm) raw = raw.log().eval();
    state.logarithm = logarithm;
    state.offset = raw.mean();
    state.scale = std::sqrt((raw - state.offset).square().mean());
    return (raw - state.offset) / state.scale;
}

/// What the settings that come again say about the noise.
Noise noise_shown_by_repeats(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
    std::map<std::vector<double>, std::pair<double, bool>> values;  // of a setting, and whether it came again
    std::size_t repeated = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const Eigen::VectorXd row = x.row(i);
        const auto [at, first] = values.try_emplace(std::vector<double>(row.begin(), row.end()), y(i), false);
        if (first) continue;
        auto& [value, again] = at->second;
        if (y(i) != value) return Noise::scatter;
        if (!std::exchange(again, true)) ++repeated;
    }
    return repeated < repeats_that_show ? Noise::scatter : Noise::misfit;
}

/// Leave-one-out figures and the local noise, which rests on them.
void assess(ResponseModel::State& state) {
    const Kriging& k = state.kriging;
    const response::LeftOut out = response::leave_one_out(k);
    state.noise = {k.points, out.residual.array().square() / out.variance.array()};
    const Eigen::ArrayXd local = state.noise.factors(state.noise.points, true);
    ModelQuality& q = state.quality;
    q.rests_on = static_cast<std::size_t>(k.size());
    q.logarithm = state.logarithm;
    Eigen::ArrayXd y(k.size()), residuals(k.size()), errors(k.size()), scatter(k.size());
    for (Eigen::Index i = 0; i < k.size(); ++i) {
        const double expected = state.mean_at(k.values(i) - out.residual(i));
        y(i) = state.logarithm ? std::exp(state.offset + state.scale * k.values(i))
                               : state.offset + state.scale * k.values(i);
        residuals(i) = state.logarithm ? y(i) - expected : state.scale * out.residual(i);
        errors(i) = state.deviation(expected, local(i) * out.variance(i));
        scatter(i) = state.deviation(expected, local(i) * state.scatter());
    }
    const Eigen::ArrayXd scores = residuals.abs() / errors;
    const double spread = std::sqrt((y - y.mean()).square().mean());
    q.leave_one_out_error = std::sqrt(residuals.square().mean()) / spread;
    q.coverage_50 = (scores < student_quantile(static_cast<double>(state.noise.freedom()), 0.75)).cast<double>().mean();
    q.coverage_95 = (scores < student_factor(state.noise.freedom())).cast<double>().mean();
    q.noise_share = std::min(1.0, scatter.square().mean() / (spread * spread));
    q.learned_map = !k.h.shear.isIdentity(0);
    q.residuals.assign(residuals.begin(), residuals.end());
    q.errors.assign(errors.begin(), errors.end());
    for (const double l : k.h.log_length) q.lengths.push_back(std::exp(l));
}

std::optional<response::Hyperparameters> search(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, bool logarithm,
                                                const ResponseModelOptions& options) {
    ResponseModel::State scaled;
    return response::find_hyperparameters(x, standardise(scaled, y, logarithm),
                                          {options.starts, options.cases_in_fit, options.map});
}

/// Returns the leave-one-out error divided by the sd of the response. For a response with a long tail few cases decide
/// the error, so it uses more cases than the search for the hyperparameters.
double error_left_out(const response::Hyperparameters& h, const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                      bool logarithm) {
    ResponseModel::State state;
    const Eigen::VectorXd z = standardise(state, y, logarithm);
    const auto chosen = response::spread_choice(z.size(), cases_compared);
    auto kriging = response::solve_kriging(h, x(chosen, Eigen::all), z(chosen));
    if (!kriging) return std::numeric_limits<double>::infinity();
    state.kriging = std::move(*kriging);
    assess(state);
    return state.quality.leave_one_out_error;
}

struct Found {
    std::optional<response::Hyperparameters> hyperparameters;
    bool of_logarithm = false;
    double error_without = unknown, error_with = unknown;
};

/// The response's hyperparameters or its logarithm's: both searches side by side where both are asked for.
Found with_or_without_logarithm(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const ResponseModelOptions& options) {
    if (options.logarithm == LogResponse::never || !(y.minCoeff() > 0) ||
        y.maxCoeff() < worth_a_logarithm * y.minCoeff())
        return {search(x, y, false, options)};
    const auto candidate = [&](bool logarithm) {
        auto h = search(x, y, logarithm, options);
        const double error = h ? error_left_out(*h, x, y, logarithm) : unknown;
        return std::pair{std::move(h), error};
    };
    auto other = std::async(std::launch::async, candidate, true);
    auto [without, error_without] = candidate(false);
    auto [with, error_with] = other.get();
    const bool better = error_with < kept_below * error_without;
    return {better ? std::move(with) : std::move(without), better, error_without, error_with};
}

}  // namespace

std::string shown(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

double ResponseModel::State::standardised(double response) const {
    return ((logarithm ? std::log(response) : response) - offset) / scale;
}

double ResponseModel::State::mean_at(double z) const {
    const double at = offset + scale * z;
    return logarithm ? std::exp(at + scale * scale * scatter() / 2) : at;
}

double ResponseModel::State::deviation(double mean, double variance) const {
    return logarithm ? mean * std::sqrt(std::expm1(scale * scale * variance)) : scale * std::sqrt(variance);
}

double Prediction::run_error() const {
    return std::hypot(mean_error, scatter);
}

double Prediction::mean_half_width() const {
    return half_width_factor(freedom) * mean_error;
}

double Prediction::run_half_width() const {
    return half_width_factor(freedom) * run_error();
}

double Prediction::mean_low() const {
    return latent ? std::min(mean, normal_cdf(latent->mean - half_width_factor(freedom) * latent->error))
                  : mean - mean_half_width();
}

double Prediction::mean_high() const {
    return latent ? std::max(mean, normal_cdf(latent->mean + half_width_factor(freedom) * latent->error))
                  : mean + mean_half_width();
}

Eigen::MatrixXd ResponseModel::State::in_box(Rows points) const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (points.dimensions != static_cast<std::size_t>(low.size()) || points.values.size() % points.dimensions != 0)
        throw std::invalid_argument("response model: points have another number of features");
    const Eigen::Map<const RowMajor> raw(points.values.data(), static_cast<Eigen::Index>(points.size()), low.size());
    return (raw.rowwise() - low.transpose()).array().rowwise() / (high - low).transpose().array();
}

Prediction ResponseModel::predict(std::span<const double> features) const {
    return predict(Rows{features, features.size()}).front();
}

std::vector<Prediction> ResponseModel::predict(Rows points) const {
    const State& s = *state_;
    const Eigen::MatrixXd x = s.in_box(points);
    const Eigen::MatrixXd at = response::mapped(s.kriging.h, x);
    const auto p = response::predict(s.kriging, at);
    const Eigen::VectorXd local = s.noise.factors(at);
    std::vector<Prediction> result;
    for (Eigen::Index i = 0; i < at.rows(); ++i) {
        const bool inside = x.row(i).minCoeff() >= -outside_by && x.row(i).maxCoeff() <= 1 + outside_by;
        const double mean = s.mean_at(p.mean(i));
        result.push_back({mean, s.deviation(mean, local(i) * (p.variance(i) + s.misfit())),
                          s.deviation(mean, local(i) * s.scatter()), inside, freedom(),
                          s.deviation(mean, s.scatter())});
    }
    return result;
}

std::vector<double> ResponseModel::means(Rows points) const {
    const State& s = *state_;
    const Eigen::VectorXd z = response::predict_means(s.kriging, response::mapped(s.kriging.h, s.in_box(points)));
    std::vector<double> result;
    for (const double mean : z) result.push_back(s.mean_at(mean));
    return result;
}

ResponseModel ResponseModel::with_cases(Rows points, std::span<const double> values) const {
    check_sizes(points, values.size());
    if (!all_finite(points.values) || !all_finite(values))
        throw std::invalid_argument("response model: an added case is not finite");
    Eigen::VectorXd z(static_cast<Eigen::Index>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (state_->logarithm && !(values[i] > 0))
            throw std::invalid_argument("response model: an added case has no logarithm");
        z(static_cast<Eigen::Index>(i)) = state_->standardised(values[i]);
    }
    auto longer = response::extend_kriging(state_->kriging, state_->in_box(points), z);
    if (!longer) throw std::invalid_argument("response model: an added case repeats another without any noise");
    auto next = std::make_shared<State>(State{state_->low, state_->high, state_->offset, state_->scale,
                                              state_->logarithm, std::move(*longer), state_->noise, state_->quality});
    next->quality.cases += values.size();
    next->quality.rests_on += values.size();
    return ResponseModel(std::move(next));
}

const ModelQuality& ResponseModel::quality() const {
    return state_->quality;
}

std::size_t ResponseModel::dimensions() const {
    return static_cast<std::size_t>(state_->low.size());
}

double ResponseModel::freedom() const {
    return static_cast<double>(state_->noise.freedom());
}

std::variant<ResponseModel, Refusal> fit_response(Rows points, std::span<const double> values,
                                                  const ResponseModelOptions& options) {
    check_sizes(points, values.size());
    auto state = std::make_shared<ResponseModel::State>();
    state->low = edges(options.low, points.dimensions, 0);
    state->high = edges(options.high, points.dimensions, 1);
    if (!((state->high - state->low).array() > 0).all())
        throw std::invalid_argument("response model: the box of a feature is empty");
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i])) used.push_back(i);
    if (const auto reason = reason_to_refuse(points, values, used)) return *reason;

    Eigen::VectorXd y(static_cast<Eigen::Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i) y(static_cast<Eigen::Index>(i)) = values[used[i]];
    Eigen::MatrixXd x = state->in_box(points)(used, Eigen::all);
    state->quality.noise = noise_shown_by_repeats(x, y);
    state->quality.cases = used.size();
    state->quality.excluded = values.size() - used.size();
    auto [found, logarithm, plain_error, log_error] = with_or_without_logarithm(x, y, options);
    Eigen::VectorXd z = standardise(*state, y, logarithm);
    if (found && logarithm && used.size() > options.cases_in_fit)
        found = response::follow(*found, x, z, options.cases_followed);
    if (used.size() > options.most_cases) {
        const auto chosen = response::space_filling_choice(x, options.most_cases);
        x = x(chosen, Eigen::all).eval();
        z = z(chosen).eval();
        for (std::size_t i = 0; i < chosen.size(); ++i) used[i] = used[static_cast<std::size_t>(chosen[i])];
        used.resize(chosen.size());
    }
    auto kriging = found ? response::solve_kriging(*found, x, z) : std::nullopt;
    if (!kriging) return Refusal{"no response model: its equations are singular in double precision"};
    state->kriging = std::move(*kriging);
    state->quality.used = std::move(used);
    assess(*state);
    state->quality.error_without_logarithm = plain_error;
    state->quality.error_with_logarithm = log_error;
    if (!(state->quality.leave_one_out_error < options.refused_error))
        return Refusal{"no response model: left-out cases are predicted with an error of " +
                       shown(state->quality.leave_one_out_error) + " standard deviations of the response (limit " +
                       shown(options.refused_error) + "), " + std::to_string(state->quality.cases) +
                       " cases do not show how it depends on these factors"};
    return ResponseModel(std::move(state));
}

}  // namespace grainsweep::stats
