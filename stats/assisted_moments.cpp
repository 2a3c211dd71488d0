#include "stats/assisted_moments.hpp"

#include "stats/confidence.hpp"
#include "stats/moment_statistics.hpp"
#include "stats/response/beyond_cases.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/kriging.hpp"
#include "stats/spread.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t least_sequences = 4, least_rare = 30, least_scramblings = 4;
constexpr std::size_t first_of_shape = 2;       // g1, in the order of the statistics
constexpr std::size_t points_of_levels = 2048;  // of each scrambling
constexpr double contradiction = 2;             // in joint half-widths
constexpr std::int64_t least_freedom = 2;
// Cases from which on, and error of the models (in sd) below which, two estimates of one variance are averaged.
constexpr std::size_t fewest_averaged = 200;
constexpr double largest_error_averaged = 0.5;

/// Cases with a value, in the box and standardised.
struct Cases {
    Eigen::MatrixXd x;
    Eigen::VectorXd z;
    std::vector<std::size_t> sequence;
    std::vector<double> noise;  ///< of each, in units of sd^2; empty: unknown
    std::size_t sequences = 0;
    double offset = 0, scale = 1;
};

Eigen::VectorXd edge(const std::vector<double>& given, std::size_t d, double otherwise) {
    if (given.empty()) return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(d), otherwise);
    if (given.size() != d) throw std::invalid_argument("assisted moments: the box has another number of features");
    return Eigen::Map<const Eigen::VectorXd>(given.data(), static_cast<Eigen::Index>(d));
}

Eigen::MatrixXd in_box(Rows rows, const AssistedSettings& settings) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::VectorXd low = edge(settings.low, rows.dimensions, 0), high = edge(settings.high, rows.dimensions, 1);
    const Eigen::Map<const RowMajor> raw(rows.values.data(), static_cast<Eigen::Index>(rows.size()),
                                         static_cast<Eigen::Index>(rows.dimensions));
    return (raw.rowwise() - low.transpose()).array().rowwise() / (high - low).transpose().array();
}

void check_input(const AssistedInput& input) {
    const std::size_t n = input.values.size(), d = input.points.dimensions;
    const bool noise = input.noise_variance.size() <= 1 || input.noise_variance.size() == n;
    if (d == 0 || input.points.values.size() != n * d || input.sequences.size() != n || !noise)
        throw std::invalid_argument("assisted moments: points, values, sequences and noise are of different numbers");
    if (input.integration.dimensions != d || input.scramblings == 0 || input.integration.size() == 0 ||
        input.integration.size() % input.scramblings != 0)
        throw std::invalid_argument("assisted moments: integration points do not split into scramblings of one size");
}

Cases gather(const AssistedInput& input, const AssistedSettings& settings) {
    Cases c;
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < input.values.size(); ++i)
        if (std::isfinite(input.values[i])) used.push_back(i);
    c.z.resize(static_cast<Eigen::Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i) {
        c.z(static_cast<Eigen::Index>(i)) = input.values[used[i]];
        c.sequence.push_back(input.sequences[used[i]]);
        c.sequences = std::max(c.sequences, c.sequence.back() + 1);
    }
    if (used.empty()) return c;
    c.x = in_box(input.points, settings)(used, Eigen::all);
    c.offset = c.z.mean();
    c.scale = std::sqrt((c.z.array() - c.offset).square().mean());
    c.z = (c.z.array() - c.offset) / c.scale;
    if (input.noise_variance.empty()) return c;
    for (const std::size_t i : used)
        c.noise.push_back(input.noise_variance[input.noise_variance.size() == 1 ? 0 : i] / (c.scale * c.scale));
    return c;
}

std::optional<Refusal> reason_against_assisting(const AssistedInput& input, const Cases& c) {
    const std::size_t n = c.sequence.size(), least = 2 * std::max<std::size_t>(12, 4 * (input.points.dimensions + 1));
    std::vector<std::size_t> sizes(c.sequences, 0);
    for (const std::size_t s : c.sequence) ++sizes[s];
    if (c.sequences < least_sequences || std::ranges::min(sizes) < 2)
        return Refusal{"no model-assisted moments: they need at least 4 independently randomised sequences of 2 cases"};
    if (n < least)
        return Refusal{"no model-assisted moments: too few cases, " + std::to_string(n) + " with a value where " +
                       std::to_string(input.points.dimensions) + " features need at least " + std::to_string(least)};
    if (const auto reason = reason_against_powers(input.values, 2); !reason.empty())
        return Refusal{"no model-assisted moments: " + reason};
    if (!c.x.allFinite()) return Refusal{"no model-assisted moments: a feature of a case is not a finite number"};
    std::map<double, std::size_t> counts;
    for (const double y : input.values)
        if (std::isfinite(y)) ++counts[y];
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    if (counts.size() == 1 || !(c.scale > 0) || !c.z.allFinite())
        return Refusal{"no model-assisted moments: the response is constant"};
    if (2 * most->second > n && n - most->second < least_rare)
        return Refusal{"no moments with an error that holds: only " + std::to_string(n - most->second) + " of " +
                       std::to_string(n) + " responses differ from " + shown(most->first) +
                       ", 30 are needed for either estimate"};
    return std::nullopt;
}

/// Sums over integration points and residuals, by sequence.
struct Parts {
    std::vector<std::vector<RawMoments>> integrals;  ///< [sequence][scrambling]: mean of g_p
    std::vector<RawMoments> residuals;               ///< of each case: z^p - g_p
    std::vector<double> predicted;                   ///< m_s(x_i)
    response::BeyondCases beyond;
    std::vector<std::vector<double>> spread;  ///< [sequence]: m_s at the integration points; empty: not wanted
    std::vector<double> noise;                ///< [sequence]: sqrt(v)
    double error = 0;                         ///< rms of z_i - m_s(x_i)
};

/// Everything for the sequences of one parity, with hyperparameters of the others.
bool add_half(Parts& parts, const Cases& c, const Eigen::MatrixXd& integration, std::size_t scramblings,
              const AssistedSettings& settings, std::size_t parity) {
    std::vector<Eigen::Index> teachers;
    for (std::size_t i = 0; i < c.sequence.size(); ++i)
        if (c.sequence[i] % 2 != parity) teachers.push_back(static_cast<Eigen::Index>(i));
    const auto h = response::find_hyperparameters(c.x(teachers, Eigen::all), c.z(teachers),
                                                  {settings.starts, settings.cases_in_fit, LearnedMap::where_better});
    if (!h) return false;
    const auto training = response::spread_choice(c.z.size(), settings.most_training);
    const auto model = response::solve_kriging(*h, c.x(training, Eigen::all), c.z(training));
    if (!model) return false;
    std::vector<std::size_t> folds;
    for (std::size_t s = parity; s < c.sequences; s += 2) folds.push_back(s);
    std::vector<std::vector<Eigen::Index>> left_out(folds.size());
    for (std::size_t k = 0; k < training.size(); ++k) {
        const std::size_t s = c.sequence[static_cast<std::size_t>(training[k])];
        if (s % 2 == parity) left_out[s / 2].push_back(static_cast<Eigen::Index>(k));
    }
    const Eigen::MatrixXd inverse = response::inverse_of(*model);
    const response::FoldWeights weights = response::leave_folds_out(*model, inverse, left_out);
    const double v = h->noise() > 2 * response::smallest_noise ? h->noise() : 0;
    const Eigen::MatrixXd taught = c.x(training, Eigen::all);
    parts.beyond.add(*model, inverse, taught, integration, v);

    const Eigen::MatrixXd means = weights.predict(*model, response::mapped(*h, integration));
    const auto each = static_cast<std::size_t>(means.rows()) / scramblings;
    for (std::size_t f = 0; f < folds.size(); ++f) {
        auto& integrals = parts.integrals[folds[f]];
        integrals.assign(scramblings, RawMoments{});
        if (!settings.levels.empty()) {
            const auto column = means.col(static_cast<Eigen::Index>(f));
            auto& spread = parts.spread[folds[f]];
            spread.clear();
            for (std::size_t k = 0; k < scramblings; ++k) {
                const auto from = column.begin() + static_cast<Eigen::Index>(k * each);
                spread.insert(spread.end(), from, from + static_cast<Eigen::Index>(std::min(each, points_of_levels)));
            }
            parts.noise[folds[f]] = std::sqrt(v);
        }
        for (std::size_t q = 0; q < each * scramblings; ++q) {
            const RawMoments g =
                response::closure(means(static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(f)), v);
            for (std::size_t p = 0; p < 4; ++p) integrals[q / each][p] += g[p] / static_cast<double>(each);
        }
    }
    const Eigen::MatrixXd at_cases = weights.predict(*model, response::mapped(*h, c.x));
    for (std::size_t i = 0; i < c.sequence.size(); ++i) {
        if (c.sequence[i] % 2 != parity) continue;
        const auto row = static_cast<Eigen::Index>(i);
        parts.predicted[i] = at_cases(row, static_cast<Eigen::Index>(c.sequence[i] / 2));
        const RawMoments seen = response::closure(c.z(row), 0), expected = response::closure(parts.predicted[i], v);
        for (std::size_t p = 0; p < 4; ++p) parts.residuals[i][p] = seen[p] - expected[p];
    }
    return true;
}

/// M^(s) of every sequence.
std::vector<RawMoments> by_sequence(const Parts& parts, const Cases& c) {
    std::vector<RawMoments> all(c.sequences, RawMoments{});
    std::vector<double> sizes(c.sequences, 0);
    for (const std::size_t s : c.sequence) ++sizes[s];
    for (std::size_t i = 0; i < c.sequence.size(); ++i)
        for (std::size_t p = 0; p < 4; ++p) all[c.sequence[i]][p] += parts.residuals[i][p] / sizes[c.sequence[i]];
    for (std::size_t s = 0; s < c.sequences; ++s)
        for (const RawMoments& g : parts.integrals[s])
            for (std::size_t p = 0; p < 4; ++p) all[s][p] += g[p] / static_cast<double>(parts.integrals[s].size());
    return all;
}

RawMoments averaged(const std::vector<RawMoments>& all) {
    RawMoments mean{};
    for (const RawMoments& m : all)
        for (std::size_t p = 0; p < 4; ++p) mean[p] += m[p] / static_cast<double>(all.size());
    return mean;
}

/// (b) and (c) of the header.
double half_width_by_cases(const RawMoments& gradient, const Parts& parts) {
    double squares = 0, fourths = 0, expected = 0;
    const double s =
        std::min(parts.error, 1.0);  // a model that says less than the mean is no noisier than the responses
    for (std::size_t i = 0; i < parts.residuals.size(); ++i) {
        const double square = std::pow(response::dot(gradient, parts.residuals[i]), 2);
        squares += square;
        fourths += square * square;
        expected += response::normal_variance(gradient, parts.predicted[i], s);
    }
    const auto n = static_cast<double>(parts.residuals.size());
    const double effective = fourths > 0 ? squares * squares / fourths : n;
    const auto freedom = std::max<std::int64_t>(static_cast<std::int64_t>(effective) - 1, least_freedom);
    return std::max(student_factor(freedom) * std::sqrt(squares / (n * (n - 1))), normal_95 * std::sqrt(expected) / n);
}

/// (a), (b), (c) and the error of Q of the header, for one gradient.
double half_width(const RawMoments& gradient, const std::vector<RawMoments>& sequences, const Parts& parts) {
    std::vector<double> values;
    for (const RawMoments& m : sequences) values.push_back(response::dot(gradient, m));
    const double by_cases = half_width_by_cases(gradient, parts);
    const std::size_t scramblings = parts.integrals.front().size();
    std::vector<double> integrals(scramblings, 0);
    for (const auto& sequence : parts.integrals)
        for (std::size_t k = 0; k < scramblings; ++k)
            integrals[k] += response::dot(gradient, sequence[k]) / static_cast<double>(parts.integrals.size());
    const double by_points = scramblings >= least_scramblings ? student_half_width(integrals) : 0;
    const double by_sequences = student_half_width(values);
    const bool averaged = parts.residuals.size() >= fewest_averaged && parts.error < largest_error_averaged;
    const double error = averaged ? std::sqrt((by_sequences * by_sequences + by_cases * by_cases) / 2)
                                  : std::max(by_sequences, by_cases);
    return std::hypot(error, by_points, parts.beyond.half_width(gradient));
}

/// What scatter adds to M_1 ... M_4, and how that moves with them.
struct Scatter {
    RawMoments added{};
    double variance = 0;  ///< E v

    /// Gradient by the M with scatter of a function of the M without.
    [[nodiscard]] RawMoments through(RawMoments gradient) const {
        gradient[0] -= 3 * variance * gradient[2];
        gradient[1] -= 6 * variance * gradient[3];
        return gradient;
    }
};

/// E[m v] = E m E v + cov(m, v) and so on: means from M, which is known better than the cases alone say, covariances
/// from the cases, zero where the noise is the same everywhere.
Scatter scatter_of(const Cases& c, const Parts& parts, const RawMoments& raw) {
    Scatter s;
    const auto n = static_cast<double>(c.noise.size());
    double m = 0, m2 = 0, mv = 0, m2v = 0, v2 = 0;
    for (std::size_t i = 0; i < c.noise.size(); ++i) {
        const double predicted = parts.predicted[i], v = c.noise[i];
        s.variance += v / n;
        m += predicted / n;
        m2 += predicted * predicted / n;
        mv += predicted * v / n;
        m2v += predicted * predicted * v / n;
        v2 += v * v / n;
    }
    const double with_mean = raw[0] * s.variance + mv - m * s.variance;
    const double with_square = (raw[1] - s.variance) * s.variance + m2v - m2 * s.variance;
    s.added = {0, s.variance, 3 * with_mean, 6 * with_square + 3 * v2};
    return s;
}

/// In the unit of the response.
AssistedEstimate in_unit(const Cases& c, std::size_t statistic, double value, double error) {
    if (statistic == 0) return {c.offset + c.scale * value, c.scale * error};
    if (statistic == 1) return {c.scale * value, c.scale * error};
    return {value, error};
}

void add_plain(AssistedMoments& result, const AssistedInput& input) {
    Moments pooled;
    std::vector<Moments> parts(std::ranges::max(input.sequences) + 1);
    for (std::size_t i = 0; i < input.values.size(); ++i) {
        pooled.add(input.values[i]);
        parts[input.sequences[i]].add(input.values[i]);
    }
    for (std::size_t k = 0; k < assisted_statistics.size(); ++k) {
        std::vector<double> values;
        for (const Moments& part : parts) values.push_back(part.summary().of(assisted_statistics[k]));
        result.statistics[k].plain = {pooled.summary().of(assisted_statistics[k]), student_half_width(values)};
    }
    result.excluded = static_cast<std::size_t>(pooled.excluded()) + input.failed;
}

void add_assisted(AssistedMoments& result, const Cases& c, const Parts& parts, double noise_error) {
    const auto sequences = by_sequence(parts, c);
    const RawMoments raw = averaged(sequences);
    const Scatter scatter = scatter_of(c, parts, raw);
    RawMoments bare = raw;
    for (std::size_t p = 0; p < 4; ++p) bare[p] -= scatter.added[p];
    const auto with = moment_statistics(raw), without = moment_statistics(bare);
    for (std::size_t k = 0; k < assisted_statistics.size(); ++k) {
        auto& s = result.statistics[k];
        s.assisted = in_unit(c, k, with[k].value, half_width(with[k].gradient, sequences, parts));
        s.shorter = s.assisted.half_width < s.plain.half_width;
        if (c.noise.empty()) continue;
        const RawMoments gradient = scatter.through(without[k].gradient);
        const double by_noise = normal_95 * noise_error * std::abs(response::dot(without[k].gradient, scatter.added));
        const double error = std::hypot(half_width(gradient, sequences, parts), by_noise);
        s.without_scatter = in_unit(c, k, without[k].value, error);
    }
    const auto whole = central_moments(raw), response = central_moments(bare);
    for (std::size_t p = 0; p < 3 && !c.noise.empty(); ++p) {
        const double unit = std::pow(whole[0], static_cast<double>(p + 2) / 2);
        result.budget[p] = {response[p] / unit, (whole[p] - response[p]) / unit};
    }
}

/// Levels in the unit of the response.
void add_levels(AssistedMoments& result, const Cases& c, Parts parts, const AssistedSettings& settings) {
    const std::size_t scramblings = parts.integrals.front().size();
    if (result.endless || result.unforeseen || !(result.model_error < settings.refused_error)) return;
    LeftOutPredictions model{.values = {c.z.begin(), c.z.end()},
                             .predicted = std::move(parts.predicted),
                             .sequences = c.sequence,
                             .scramblings = scramblings,
                             .spread = std::move(parts.spread),
                             .noise = std::move(parts.noise)};
    for (const Level& level : settings.levels) {
        if (const auto* beyond = std::get_if<Exceedance>(&level)) {
            const double standardised = (beyond->threshold - c.offset) / c.scale;
            const auto found = assisted_level_of(Exceedance{standardised, beyond->above}, model);
            result.levels.push_back({level, found.value, found.error});
        } else {
            const auto found = assisted_level_of(level, model);
            result.levels.push_back({level, c.offset + c.scale * found.value, c.scale * found.error});
        }
    }
}

/// Cases without a value make two populations, whose moments may differ without a contradiction.
std::string reason_for_the_plain(const AssistedMoments& result) {
    if (result.excluded == 0) return " is withdrawn: it contradicts the plain ";
    return " of the whole box is not taken: the " + std::to_string(result.cases) + " of " +
           std::to_string(result.cases + result.excluded) + " cases with a value have ";
}

void choose(AssistedMoments& result, const AssistedSettings& settings, const AssistedMoments* previous) {
    const auto unforeseen = result.unforeseen || previous == nullptr ? result.unforeseen : previous->unforeseen;
    const bool good = result.model_error < settings.refused_error && !unforeseen;
    if (unforeseen)
        result.remark =
            "the plain estimates stand: the response seems to have no end, and predicted from all others its outermost "
            "cases are missed by " +
            shown(100 * *unforeseen) + " % of their distance from the mean";
    else if (!good)
        result.remark = "the plain estimates stand: left-out sequences are predicted with an error of " +
                        shown(result.model_error) + " standard deviations (limit " + shown(settings.refused_error) +
                        ")";
    if (good && result.endless)
        result.remark =
            "g1 and kurtosis are the plain ones: the response seems to have no end, and a model says nothing of "
            "its tail";
    for (std::size_t k = 0; k < assisted_statistics.size(); ++k) {
        auto& s = result.statistics[k];
        const double joint = std::hypot(s.plain.half_width, s.assisted.half_width);
        const bool finite = std::isfinite(s.assisted.half_width + s.assisted.value);
        const bool differs = good && std::abs(s.assisted.value - s.plain.value) > contradiction * joint;
        const bool of_tails = result.endless && k >= first_of_shape;
        s.withdrawn = !good || of_tails || (differs && result.excluded == 0);
        s.takes_assisted =
            finite && good && !of_tails && !differs && (previous == nullptr || previous->statistics[k].shorter);
        if (!differs) continue;
        result.remark += (result.remark.empty() ? "the model-assisted " : "; the model-assisted ") +
                         std::string(to_string(assisted_statistics[k])) + " " + shown(s.assisted.value) + " +- " +
                         shown(s.assisted.half_width) + reason_for_the_plain(result) + shown(s.plain.value) + " +- " +
                         shown(s.plain.half_width);
    }
}

/// Both estimators, nothing chosen.
std::variant<AssistedMoments, Refusal> assisted_estimate(const AssistedInput& input, const AssistedSettings& settings) {
    const Cases c = gather(input, settings);
    if (const auto reason = reason_against_assisting(input, c)) return *reason;
    Parts parts{std::vector<std::vector<RawMoments>>(c.sequences),
                std::vector<RawMoments>(c.sequence.size()),
                std::vector<double>(c.sequence.size()),
                response::BeyondCases({c.z.data(), static_cast<std::size_t>(c.z.size())}, c.sequences),
                std::vector<std::vector<double>>(c.sequences),
                std::vector<double>(c.sequences, 0)};
    const Eigen::MatrixXd integration = in_box(input.integration, settings);
    for (const std::size_t parity : {std::size_t{0}, std::size_t{1}})
        if (!add_half(parts, c, integration, input.scramblings, settings, parity))
            return Refusal{"no model-assisted moments: the equations of the model are singular in double precision"};
    AssistedMoments result;
    result.cases = c.sequence.size();
    add_plain(result, input);
    double squares = 0;
    for (std::size_t i = 0; i < result.cases; ++i)
        squares += std::pow(c.z(static_cast<Eigen::Index>(i)) - parts.predicted[i], 2);
    result.model_error = parts.error = std::sqrt(squares / static_cast<double>(result.cases));
    add_assisted(result, c, parts, input.noise_variance_error);
    result.endless = parts.beyond.endless();
    if (parts.beyond.says_nothing()) result.unforeseen = parts.beyond.unforeseen();
    if (!settings.levels.empty()) add_levels(result, c, std::move(parts), settings);
    return result;
}

/// The first half of the rows.
AssistedInput first_half(const AssistedInput& input) {
    AssistedInput half = input;
    const std::size_t n = input.values.size() / 2;
    half.points.values = input.points.values.first(n * input.points.dimensions);
    half.values = input.values.first(n);
    half.sequences = input.sequences.first(n);
    if (input.noise_variance.size() > 1) half.noise_variance = input.noise_variance.first(n);
    return half;
}

}  // namespace

const AssistedStatistic& AssistedMoments::of(Statistic statistic) const {
    const auto found = std::ranges::find(assisted_statistics, statistic);
    if (found == assisted_statistics.end()) throw std::invalid_argument("assisted moments: no such statistic");
    return statistics[static_cast<std::size_t>(found - assisted_statistics.begin())];
}

std::variant<AssistedMoments, Refusal> assisted_moments(const AssistedInput& input, const AssistedSettings& settings,
                                                        const AssistedMoments* previous) {
    check_input(input);
    auto answer = assisted_estimate(input, settings);
    auto* result = std::get_if<AssistedMoments>(&answer);
    if (result == nullptr) return answer;
    std::variant<AssistedMoments, Refusal> half = Refusal{};
    if (previous == nullptr && result->model_error < settings.refused_error) {
        half = assisted_estimate(first_half(input), settings);
        previous = std::get_if<AssistedMoments>(&half);
    }
    choose(*result, settings, previous);
    return answer;
}

}  // namespace grainsweep::stats
