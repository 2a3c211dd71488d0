#include "sweep/designs/calibration.hpp"

#include "solver/plain_text.hpp"
#include "stats/calibration.hpp"
#include "stats/several_responses.hpp"
#include "sweep/designs/calibration_layout.hpp"
#include "sweep/designs/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>

namespace grainsweep::designs {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double ruled_out = 3;  // implausibility, standard deviations
constexpr std::int64_t fewest_candidates = 1 << 13, most_candidates = 1 << 15;
constexpr std::size_t enough_kept = 8;       // candidates for each setting of the next wave
constexpr std::size_t most_compared = 4096;  // among which the next settings are spread
constexpr std::size_t chains_begin_at = 64;  // settings of least implausibility

/// Returns the points with the coordinates of levels and multiples moved to the middle of their part.
std::vector<double> in_the_middle(std::span<const FactorRange> factors, std::vector<double> points) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = factors[i % factors.size()].middle(points[i]);
    return points;
}

/// Sobol points of the calibrated factors, rows of d.
std::vector<double> even_points(const DesignRequest& request, std::span<const FactorRange> factors, std::int64_t count,
                                std::uint64_t stream) {
    const DesignRequest sobol{
        .levels = std::vector<std::size_t>(factors.size(), 0),
        .options = {{"points", count}, {"scramble", std::string("random")}, {"sequences", std::int64_t{1}}},
        .seed = draw_key(request.seed, DrawPurpose::calibration, stream)};
    return in_the_middle(factors, design_named("sobol").sample(sobol).coordinates);
}

/// Adds the inputs of a response model for the factor at u: one number or, for more than two words, an indicator of
/// each word but the first. Levels that are numbers count by their order.
void add_inputs(std::vector<double>& row, const FactorRange& factor, double u) {
    if (factor.levels.empty() || (factor.has_words() && factor.parts <= 2)) {
        row.push_back(factor.middle(u));
    } else if (factor.has_words()) {
        for (std::size_t k = 1; k < factor.parts; ++k) row.push_back(factor.part(u) == k ? 1 : 0);
    } else {
        const auto numbers = numbers_in(factor.levels);
        const auto below = std::ranges::count_if(numbers, [&](double x) { return x < numbers[factor.part(u)]; });
        row.push_back((static_cast<double>(below) + 0.5) / static_cast<double>(factor.parts));
    }
}

/// The course of a calibration, wave by wave.
class Course {
public:
    explicit Course(const DesignRequest& request) : request_(request) {
        result_.targets = targets_in(request.word("targets"));
        layout_ = calibration_layout(request, result_.targets);
        result_.ranges = layout_.factors;
        d_ = result_.ranges.size();
        for (const auto& range : result_.ranges) result_.factors.push_back(range.name);
        result_.points.dimensions = request.dimensions();
        values_.resize(result_.targets.size());
        const std::vector<double> centre(d_, 0.5);
        const auto model_inputs = result_.inputs({centre, d_}).width;
        const auto least = static_cast<std::int64_t>(std::max<std::size_t>(12, 4 * (model_inputs + 1)));
        if (request.count("points_per_wave") < least)
            throw std::invalid_argument("a response model of " + std::to_string(d_) +
                                        " factors needs waves of at least " + std::to_string(least) + " points");
        add_further();
    }

    Calibration run() {
        auto settings = even_points(request_, result_.ranges, request_.count("points_per_wave"), 0);
        for (std::int64_t wave = 1;; ++wave) {
            if (!ask(settings)) return std::move(result_);
            learn(settings);
            settings = next(wave, false);
            if (!result_.waves_end) continue;
            sample();
            if (!result_.posterior || !check() || !goes_on(wave)) return std::move(result_);
            result_.waves_end = false;
            learn(result_.checked, true);
            settings = next(wave, true);
            if (result_.waves_end) return std::move(result_);
        }
    }

private:
    /// Begins the settings with those that were computed elsewhere. A target under another condition has no answer
    /// there.
    void add_further() {
        const std::size_t d = request_.dimensions();
        if (!request_.shared.empty()) return;
        for (std::size_t i = 0; (i + 1) * d <= request_.further.coordinates.size(); ++i) {
            const auto point = std::span(request_.further.coordinates).subspan(i * d, d);
            for (std::size_t j = 0; j < d_; ++j)
                result_.settings.push_back(result_.ranges[j].middle(point[layout_.calibrated[j]]));
            for (std::size_t t = 0; t < result_.targets.size(); ++t) {
                const auto known = request_.further.answers.find(result_.targets[t].answers_key());
                const bool fits = std::ranges::all_of(layout_.stated, [&](std::size_t j) {
                    const auto level = result_.targets[t].level.find(request_.factors[j].name);
                    const auto here = static_cast<std::size_t>(point[j] * static_cast<double>(request_.levels[j]));
                    return here == (level == result_.targets[t].level.end() ? 0 : level->second);
                });
                values_[t].push_back(fits && known != request_.further.answers.end() ? known->second[i] : none);
            }
            ++result_.further;
        }
    }
    /// Requests the settings under every condition. Returns false if an answer is still missing.
    bool ask(const std::vector<double>& settings) {
        const std::size_t rows = settings.size() / d_;
        const auto part = static_cast<std::uint32_t>(result_.waves.size());
        first_ = asked_;
        asked_ += rows;
        bool known = true;
        for (std::size_t i = 0; i < rows; ++i) {
            const auto setting = std::span(settings).subspan(i * d_, d_);
            const auto repeat = times_asked_[{setting.begin(), setting.end()}]++;
            for (const auto& condition : layout_.conditions) {
                const auto point = point_of(setting, condition);
                result_.points.coordinates.insert(result_.points.coordinates.end(), point.begin(), point.end());
                result_.points.part.push_back(part);
                result_.points.repeat.push_back(repeat);
            }
        }
        for (std::size_t t = 0; t < result_.targets.size(); ++t)
            for (std::size_t i = 0; i < rows; ++i) known = known && answer(t, i).has_value();
        return known;
    }
    /// Returns the point of this experiment that runs a setting under a condition.
    [[nodiscard]] std::vector<double> point_of(std::span<const double> setting,
                                               const std::map<std::string, std::size_t>& condition) const {
        std::vector<double> point(request_.dimensions());
        for (std::size_t k = 0; k < layout_.calibrated.size(); ++k)
            point[layout_.calibrated[k]] = setting[layout_.column[k]];
        for (const std::size_t j : layout_.stated)
            point[j] = (static_cast<double>(level_of(condition, j)) + 0.5) / static_cast<double>(request_.levels[j]);
        return point;
    }
    /// Returns whether `where` accepts a setting under every condition; otherwise some target would have no answer.
    [[nodiscard]] bool admitted(std::span<const double> setting) const {
        return !request_.admits || std::ranges::all_of(layout_.conditions, [&](const auto& condition) {
            return request_.admits(point_of(setting, condition));
        });
    }
    [[nodiscard]] std::size_t level_of(const std::map<std::string, std::size_t>& condition, std::size_t j) const {
        const auto found = condition.find(request_.factors[j].name);
        return found == condition.end() ? 0 : found->second;
    }
    /// Returns an answer of the settings requested last.
    [[nodiscard]] std::optional<double> answer(std::size_t target, std::size_t row) const {
        const auto known = request_.answers.find(result_.targets[target].answers_key());
        const std::size_t point = layout_.point(target, first_ + row);
        if (known == request_.answers.end() || point >= known->second.size()) return std::nullopt;
        return known->second[point];
    }
    /// Models from all cases so far.
    void learn(const std::vector<double>& settings, bool of_checks = false) {
        const std::size_t rows = settings.size() / d_;
        result_.settings.insert(result_.settings.end(), settings.begin(), settings.end());
        auto& wave = result_.waves.emplace_back();
        wave.settings = rows;
        wave.of_checks = of_checks;
        result_.models.clear();
        result_.beyond.clear();
        std::vector<bool> unanswered(result_.settings.size() / d_, false);
        for (std::size_t t = 0; t < result_.targets.size(); ++t) {
            for (std::size_t i = 0; i < rows; ++i) values_[t].push_back(*answer(t, i));
            for (std::size_t i = result_.further; i < values_[t].size(); ++i)
                unanswered[i] = unanswered[i] || !std::isfinite(values_[t][i]);
        }
        const auto inputs = result_.inputs({result_.settings, d_});
        auto fits = stats::fit_responses(inputs.rows(), values_);
        for (std::size_t t = 0; t < result_.targets.size(); ++t) {
            auto& fitted = fits[t];
            if (auto* model = std::get_if<stats::ResponseModel>(&fitted)) {
                wave.model_error.push_back(model->quality().leave_one_out_error);
                wave.refusals.emplace_back();
                result_.models.emplace_back(std::move(*model));
            } else {
                wave.model_error.push_back(none);
                wave.refusals.push_back(std::get<stats::Refusal>(fitted).sentence);
                result_.models.emplace_back();
            }
            result_.beyond.push_back(stats::beyond_what_was_reached(measured(t), values_[t]));
        }
        learn_failures(unanswered);
    }
    void learn_failures(const std::vector<bool>& unanswered) {
        std::vector<double> settings;
        std::vector<bool> failed;
        for (std::size_t i = result_.further; i < unanswered.size(); ++i) {
            const auto setting = std::span(result_.settings).subspan(i * d_, d_);
            if (!admitted(setting)) continue;
            settings.insert(settings.end(), setting.begin(), setting.end());
            failed.push_back(unanswered[i]);
        }
        auto& wave = result_.waves.back();
        wave.excluded = unanswered.size() - result_.further - failed.size();
        wave.cases = failed.size() * layout_.runs;
        wave.failed = static_cast<std::size_t>(std::ranges::count(failed, true));
        result_.answering = failed.empty() ? AnsweringSettings() : AnsweringSettings({settings, d_}, failed);
    }
    [[nodiscard]] stats::Target measured(std::size_t t) const {
        const auto& target = result_.targets[t];
        return {target.value, target.error, target.discrepancy, 1};
    }
    /// Targets that have a model.
    [[nodiscard]] std::vector<stats::Target> modelled() const {
        std::vector<stats::Target> targets;
        for (std::size_t t = 0; t < result_.targets.size(); ++t)
            if (result_.models[t]) targets.push_back(measured(t));
        return targets;
    }
    [[nodiscard]] std::vector<double> modelled_covariance() const {
        std::vector<MeasuredTarget> targets;
        for (std::size_t t = 0; t < result_.targets.size(); ++t)
            if (result_.models[t]) targets.push_back(result_.targets[t]);
        return covariance_of(targets);
    }
    [[nodiscard]] std::vector<std::vector<stats::Prediction>> predict(stats::Rows points) const {
        std::vector<std::vector<stats::Prediction>> predictions;
        const auto inputs = result_.inputs(points);
        for (const auto& model : result_.models)
            if (model) predictions.push_back(model->predict(inputs.rows()));
        return predictions;
    }

    /// Even points of the box and how implausible each is.
    struct Candidates {
        std::vector<double> points, implausibility;  ///< without points that `where` excludes
        std::vector<bool> answers;                   ///< not ruled out by failures
        bool sure = true;                            ///< the models are surer than all else at every point kept
        std::vector<std::size_t> kept;
    };
    [[nodiscard]] Candidates candidates(std::int64_t count, std::uint64_t stream) const {
        Candidates all;
        const auto box = even_points(request_, result_.ranges, count, stream);
        for (std::size_t i = 0; i < box.size(); i += d_)
            if (admitted(std::span(box).subspan(i, d_))) append(all.points, box, i / d_);
        for (const double weight : result_.answering.log_weights({all.points, d_}))
            all.answers.push_back(weight > -std::numeric_limits<double>::infinity());
        const auto predictions = predict({all.points, d_});
        const auto targets = modelled();
        all.implausibility = stats::deciding_implausibility(stats::implausibilities(targets, predictions));
        for (std::size_t i = 0; i < all.implausibility.size(); ++i) {
            if (!(all.implausibility[i] < ruled_out) || !all.answers[i]) continue;
            all.kept.push_back(i);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const auto& p = predictions[k][i];
                const double others = targets[k].measured_error * targets[k].measured_error +
                                      targets[k].discrepancy * targets[k].discrepancy + p.scatter * p.scatter;
                all.sure = all.sure && p.mean_error * p.mean_error < others;
            }
        }
        return all;
    }

    /// Returns the next settings; none: the waves end. After a check without a miss only their number ends them.
    std::vector<double> next(std::int64_t wave, bool missed) {
        auto& now = result_.waves.back();
        if (const auto target = unanswered(); target && !modelled().empty()) {
            now.kept = result_.waves.size() > 1 ? result_.waves[result_.waves.size() - 2].kept : 1;
            return fail("no case has an answer to " + result_.targets[*target].answers_key());
        }
        if (modelled().empty()) {
            now.kept = result_.waves.size() > 1 ? result_.waves[result_.waves.size() - 2].kept : 1;
            if (wave == request_.count("waves")) return fail("the waves asked for are done, and no target has a model");
            return even_points(request_, result_.ranges, request_.count("points_per_wave"),
                               static_cast<std::uint64_t>(2 * wave));
        }
        const auto wanted = static_cast<std::size_t>(request_.count("points_per_wave"));
        Candidates all;
        std::int64_t count = fewest_candidates;
        do {
            all = candidates(count, static_cast<std::uint64_t>(2 * wave + 1));
            count *= 4;
        } while (all.kept.size() < enough_kept * wanted && count <= most_candidates);
        if (all.points.empty()) return fail("the campaign's `where` leaves no setting of the box");
        now.kept = static_cast<double>(all.kept.size()) / static_cast<double>(all.implausibility.size());
        result_.least_implausibility = *std::ranges::min_element(all.implausibility);
        best_ = starts(all);
        if (best_.empty()) return fail("no setting is expected to answer every target");

        const bool complete = std::ranges::all_of(now.refusals, [](const auto& text) { return text.empty(); });
        if (wave == request_.count("waves")) return end("the waves asked for are done");
        if (complete && !all.kept.empty() && all.sure && !missed)
            return end("the models are surer than measurement, discrepancy and scatter wherever a setting is kept");
        if (result_.waves.size() > 1 && !missed) {
            const double before = result_.waves[result_.waves.size() - 2].kept;
            if (complete && before - now.kept < request_.number("shrink") * before)
                return end("the last wave ruled out less than the share asked for");
        }
        return spread(all, wanted, wave);
    }
    std::vector<double> end(std::string why) {
        result_.waves_end = true;
        result_.why_they_end = std::move(why);
        return {};
    }
    /// Ends without a posterior.
    std::vector<double> fail(std::string why) {
        result_.points.without_result = why;
        return end(std::move(why));
    }
    /// A target that no case of the waves has answered.
    [[nodiscard]] std::optional<std::size_t> unanswered() const {
        for (std::size_t t = 0; t < values_.size(); ++t)
            if (std::ranges::none_of(values_[t], [](double x) { return std::isfinite(x); })) return t;
        return std::nullopt;
    }
    /// Returns the settings of smallest implausibility as starts of the chains. If none of them is expected to have an
    /// answer, returns the least implausible ones with an expected answer.
    [[nodiscard]] std::vector<double> starts(const Candidates& all) const {
        std::vector<std::size_t> order(all.implausibility.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto answers = [&](std::size_t i) { return all.answers[i]; };
        const auto sort = [&] {
            const auto last = order.begin() + static_cast<std::ptrdiff_t>(std::min(chains_begin_at, order.size()));
            std::ranges::partial_sort(order, last, {},
                                      [&](std::size_t i) { return std::pair(all.implausibility[i], i); });
            return std::span(order.begin(), last);
        };
        auto least = sort();
        if (std::ranges::none_of(least, answers)) {
            std::erase_if(order, [&](std::size_t i) { return !answers(i); });
            least = sort();
        }
        std::vector<double> points;
        for (const std::size_t i : least) append(points, all.points, i);
        return points;
    }
    void append(std::vector<double>& rows, const std::vector<double>& points, std::size_t i) const {
        const auto from = points.begin() + static_cast<std::ptrdiff_t>(i * d_);
        rows.insert(rows.end(), from, from + static_cast<std::ptrdiff_t>(d_));
    }
    /// Returns kept settings, each the farthest from all chosen and all earlier ones (greedy maximin). If hardly any
    /// setting is kept, candidates come from the posterior.
    [[nodiscard]] std::vector<double> spread(const Candidates& all, std::size_t wanted, std::int64_t wave) {
        std::vector<double> pool;
        const std::size_t step = std::max<std::size_t>(1, all.kept.size() / most_compared);
        for (std::size_t k = 0; k < all.kept.size(); k += step) append(pool, all.points, all.kept[k]);
        if (pool.size() / d_ < 2 * wanted) {
            const auto drawn = posterior(static_cast<std::uint64_t>(wave));
            pool.insert(pool.end(), drawn.points.begin(), drawn.points.end());
        }
        const std::size_t n = pool.size() / d_;
        std::vector<double> distance(n, std::numeric_limits<double>::infinity());
        const auto approach = [&](const double* from) {
            for (std::size_t i = 0; i < n; ++i) {
                double square = 0;
                for (std::size_t j = 0; j < d_; ++j) square += std::pow(pool[i * d_ + j] - from[j], 2);
                distance[i] = std::min(distance[i], square);
            }
        };
        for (std::size_t i = 0; i < result_.settings.size(); i += d_) approach(&result_.settings[i]);
        std::vector<double> chosen;
        for (std::size_t k = 0; k < std::min(wanted, n); ++k) {
            const auto i = static_cast<std::size_t>(std::ranges::max_element(distance) - distance.begin());
            append(chosen, pool, i);
            approach(&pool[i * d_]);
        }
        return chosen;
    }
    [[nodiscard]] stats::PosteriorSample posterior(std::uint64_t stream,
                                                   std::optional<stats::PosteriorShape>* shape = nullptr) const {
        const auto targets = modelled();
        const auto covariance = modelled_covariance();
        stats::PosteriorSettings settings;
        settings.seed = draw_key(request_.seed, DrawPurpose::calibration, stream, 1);
        auto sample = stats::sample_posterior(
            [&](stats::Rows drawn) {
                const auto middles = in_the_middle(result_.ranges, {drawn.values.begin(), drawn.values.end()});
                const stats::Rows points{middles, d_};
                auto density = stats::log_likelihood(targets, predict(points), covariance);
                const auto weights = result_.answering.log_weights(points);
                for (std::size_t i = 0; i < density.size(); ++i)
                    density[i] =
                        admitted(points.row(i)) ? density[i] + weights[i] : -std::numeric_limits<double>::infinity();
                return density;
            },
            {best_, d_}, settings);
        if (shape != nullptr) *shape = stats::posterior_shape(sample.rows());  // before levels lose their width
        sample.points = in_the_middle(result_.ranges, std::move(sample.points));
        return sample;
    }
    void sample() {
        if (!result_.points.without_result.empty()) return;
        result_.posterior = posterior(0, &result_.shape);
    }
    /// Requests settings drawn from the posterior. Returns false if an answer is still missing.
    bool check() {
        result_.checked.clear();
        result_.check.clear();
        const auto rows = result_.posterior->rows();
        const auto checks = std::min(static_cast<std::size_t>(request_.count("checks")), rows.size());
        for (std::size_t k = 0; k < checks; ++k)
            append(result_.checked, result_.posterior->points, (2 * k + 1) * rows.size() / (2 * checks));
        result_.checks_known = ask(result_.checked);
        for (std::size_t t = 0; t < result_.targets.size(); ++t) {
            auto& answers = result_.check.emplace_back();
            for (std::size_t k = 0; k < checks; ++k) answers.push_back(answer(t, k).value_or(none));
        }
        return result_.checks_known;
    }
    /// Whether the check missed a measurement of several experiments, and waves are left.
    [[nodiscard]] bool goes_on(std::int64_t wave) const {
        if (request_.shared.empty() || wave == request_.count("waves")) return false;
        const auto miss = largest_miss(result_.targets, result_.check);
        return miss && miss->size > largest_miss_allowed;
    }

    const DesignRequest& request_;
    CalibrationLayout layout_;
    std::size_t d_ = 0, asked_ = 0, first_ = 0;  ///< factors; settings so far; the first of the last request
    std::map<std::vector<double>, std::uint32_t> times_asked_;  ///< a setting of levels alone comes again: a replicate
    std::vector<std::vector<double>> values_;                   ///< of each target
    std::vector<double> best_;                                  ///< settings of least implausibility
    Calibration result_;
};

}  // namespace

ModelInputs Calibration::inputs(stats::Rows points) const {
    ModelInputs inputs;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < ranges.size(); ++j) add_inputs(inputs.values, ranges[j], points.row(i)[j]);
    if (points.size() > 0) inputs.width = inputs.values.size() / points.size();
    return inputs;
}

Calibration calibration_of(const DesignRequest& request) {
    return Course(request).run();
}

DesignInfo calibration_design() {
    const auto count = [](std::string name, std::int64_t standard, std::int64_t most, std::string meaning) {
        return OptionSpec{
            .name = std::move(name), .meaning = std::move(meaning), .default_value = standard, .maximum = most};
    };
    const auto word = [](std::string name, std::string meaning) {
        return OptionSpec{.name = std::move(name), .meaning = std::move(meaning), .kind = OptionSpec::Kind::word};
    };
    const auto points = [](const DesignRequest& request) {
        return request.grown ? *request.grown : calibration_of(request).points;
    };
    return {
        .name = "calibration",
        .summary = "Waves of points that close in on the settings which reproduce what was measured: history matching.",
        .options = {word("targets", "what was measured"),
                    word("experiment", "of several that share the waves, the one that this campaign runs"),
                    word("together", "the factors that those experiments calibrate together"),
                    count("waves", 4, 100, "waves at most"),
                    count("points_per_wave", 40, 10'000, "settings of a wave; each is run under every condition"),
                    count("checks", 8, 1000, "settings drawn from the posterior that are run to check it"),
                    {.name = "shrink",
                     .meaning = "the waves end when one rules out less than this share of what was kept",
                     .kind = OptionSpec::Kind::number,
                     .default_value = 0.02,
                     .bounds = {0, 1}}},
        .grows = true,
        .calibrates = true,
        .rests_on =
            [](const DesignRequest& request) {
                std::vector<std::string> names;
                for (const auto& target : targets_in(request.word("targets")))
                    if (std::ranges::find(names, target.answers_key()) == names.end())
                        names.push_back(target.answers_key());
                return names;
            },
        .beginning = Beginning::corner,
        .size = [points](const DesignRequest& request) { return static_cast<std::int64_t>(points(request).size()); },
        .sample = points};
}

}  // namespace grainsweep::designs
