#include "sweep/designs/calibration.hpp"

#include "solver/plain_text.hpp"
#include "stats/calibration.hpp"
#include "stats/count_likelihood.hpp"
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
std::vector<double> in_the_middle(std::span<const Factor> factors, std::vector<double> points) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = factors[i % factors.size()].middle(points[i]);
    return points;
}

/// Sobol points of the calibrated factors, rows of d.
std::vector<double> even_points(const DesignRequest& request, std::span<const Factor> factors, std::int64_t count,
                                std::uint64_t stream) {
    const DesignRequest sobol{
        .levels = std::vector<std::size_t>(factors.size(), 0),
        .options = {{"points", count}, {"scramble", std::string("random")}, {"sequences", std::int64_t{1}}},
        .seed = draw_key(request.seed, DrawPurpose::calibration, stream)};
    return in_the_middle(factors, design_named("sobol").sample(sobol).coordinates);
}

/// Adds the inputs of a response model for the factor at u: one number or, for more than two words, an indicator of
/// each word but the first. Levels that are numbers count by their order.
void add_inputs(std::vector<double>& row, const Factor& factor, double u) {
    const auto numbers = factor.level_numbers();
    const bool words = !factor.continuous() && numbers.empty();
    if (factor.continuous() || (words && factor.parts() <= 2)) {
        row.push_back(factor.middle(u));
    } else if (words) {
        for (std::size_t k = 1; k < factor.parts(); ++k) row.push_back(factor.part(u) == k ? 1 : 0);
    } else {
        const auto below = std::ranges::count_if(numbers, [&](double x) { return x < numbers[factor.part(u)]; });
        row.push_back((static_cast<double>(below) + 0.5) / static_cast<double>(factor.parts()));
    }
}

/// Error of a model from its cases, each left out in turn, divided by the standard deviation of the responses.
double relative_error(const stats::ResponseModel& model) {
    return model.quality().leave_one_out_error;
}
double relative_error(const stats::ProbabilityModel& model) {
    const auto& quality = model.quality();
    return quality.brier_of_share > 0 ? std::sqrt(quality.brier / quality.brier_of_share) : 0;
}

std::vector<stats::Prediction> predictions_of(const stats::ResponseModel& model, stats::Rows points) {
    return model.predict(points);
}
std::vector<stats::Prediction> predictions_of(const stats::ProbabilityModel& model, stats::Rows points) {
    return model.with_errors(points);
}

/// The course of a calibration, wave by wave.
class Course {
public:
    explicit Course(const DesignRequest& request) : request_(request) {
        result_.targets = targets_in(request.word("targets"));
        layout_ = calibration_layout(request, result_.targets);
        result_.factors = layout_.factors;
        d_ = result_.factors.size();
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
        auto settings = even_points(request_, result_.factors, request_.count("points_per_wave"), 0);
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
    /// Begins the settings with those that were computed elsewhere. A target of another experiment, or under another
    /// condition, has no answer there. A factor that the experiment lacks does not act on its answers.
    void add_further() {
        for (const auto& further : request_.further) {
            const std::size_t d = further.factors.size();
            for (std::size_t i = 0; (i + 1) * d <= further.coordinates.size(); ++i) {
                const auto point = std::span(further.coordinates).subspan(i * d, d);
                const auto coordinate = [&](const std::string& name) {
                    const auto own = std::ranges::find(further.factors, name, &Factor::name);
                    return own == further.factors.end()
                               ? 0.5
                               : point[static_cast<std::size_t>(own - further.factors.begin())];
                };
                for (const auto& factor : result_.factors)
                    result_.settings.push_back(factor.middle(coordinate(factor.name)));
                for (std::size_t t = 0; t < result_.targets.size(); ++t) {
                    const auto& target = result_.targets[t];
                    const auto known = further.answers.find(target.answers_key());
                    const bool fits = std::ranges::all_of(target.level, [&](const auto& condition) {
                        const auto own = std::ranges::find(further.factors, condition.first, &Factor::name);
                        return own != further.factors.end() && own->part(coordinate(own->name)) == condition.second;
                    });
                    const bool answers = known != further.answers.end() && fits;
                    values_[t].push_back(answers ? known->second[i] : none);
                }
                ++result_.further;
            }
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
        }
        for (std::size_t t = 0; t < result_.targets.size(); ++t) {
            const auto counted = counted_by(t);
            for (std::size_t i = result_.further; i < values_[t].size(); ++i)
                unanswered[i] = unanswered[i] ||
                                !(std::isfinite(values_[t][i]) || (counted && std::isfinite(values_[*counted][i])));
        }
        fit_models(wave);
        learn_failures(unanswered);
    }
    /// Returns the target that counts the missing values of another one.
    [[nodiscard]] std::optional<std::size_t> counted_by(std::size_t target) const {
        const auto& one = result_.targets[target];
        for (std::size_t t = 0; t < result_.targets.size(); ++t) {
            const auto& other = result_.targets[t];
            const auto place = place_on_curve(other.observable);
            if (t != target && place.missing && place.observable == one.observable && other.level == one.level &&
                other.experiment == one.experiment)
                return t;
        }
        return std::nullopt;
    }
    void fit_models(CalibrationWave& wave) {
        const auto inputs = result_.inputs({result_.settings, d_});
        const std::vector<double> zeros(inputs.width, 0), ones(inputs.width, 1);
        const auto add = [&]<class Model>(std::variant<Model, stats::Refusal> fitted) {
            auto* model = std::get_if<Model>(&fitted);
            wave.model_error.push_back(model != nullptr ? relative_error(*model) : none);
            wave.refusals.push_back(model != nullptr ? "" : std::get<stats::Refusal>(fitted).sentence);
            auto& kept = result_.models.emplace_back();
            if (model != nullptr) kept = std::move(*model);
        };
        std::vector<std::vector<double>> responses;
        for (std::size_t t = 0; t < result_.targets.size(); ++t)
            if (!result_.targets[t].of) responses.push_back(values_[t]);
        auto fits = stats::fit_responses(inputs.rows(), responses);
        for (std::size_t t = 0, next = 0; t < result_.targets.size(); ++t) {
            if (result_.targets[t].of)
                add(stats::fit_probability(inputs.rows(), values_[t], zeros, ones));
            else
                add(std::move(fits[next++]));
            result_.beyond.push_back(stats::beyond_what_was_reached(measured(t), values_[t]));
        }
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
    [[nodiscard]] stats::CountTarget counted(std::size_t t) const {
        const auto& target = result_.targets[t];
        return {target.count(), *target.of, target.discrepancy};
    }
    /// Returns the numbers of the targets that have a model.
    [[nodiscard]] std::vector<std::size_t> modelled() const {
        std::vector<std::size_t> numbers;
        for (std::size_t t = 0; t < result_.models.size(); ++t)
            if (result_.models[t]) numbers.push_back(t);
        return numbers;
    }
    /// Returns the predictions of each model, in the order of modelled().
    [[nodiscard]] std::vector<std::vector<stats::Prediction>> predict(stats::Rows points) const {
        std::vector<std::vector<stats::Prediction>> predictions;
        const auto inputs = result_.inputs(points);
        for (const auto t : modelled())
            predictions.push_back(std::visit([&](const auto& model) { return predictions_of(model, inputs.rows()); },
                                             *result_.models[t]));
        return predictions;
    }
    /// Returns the implausibilities of a target at some points.
    [[nodiscard]] std::vector<double> implausible(std::size_t t,
                                                  const std::vector<stats::Prediction>& predicted) const {
        if (result_.targets[t].of) return stats::implausibilities_of_count(counted(t), predicted);
        const auto target = measured(t);
        return stats::implausibilities({&target, 1}, {&predicted, 1}).front();
    }
    /// Returns the variance of a measurement about the true mean of the model at a point.
    [[nodiscard]] double other_variance(std::size_t t, const stats::Prediction& predicted) const {
        const auto& target = result_.targets[t];
        const double run = predicted.scatter * predicted.scatter;
        if (target.of) return run * (1 / static_cast<double>(*target.of) + 4 * target.discrepancy * target.discrepancy);
        return target.error * target.error + target.discrepancy * target.discrepancy + run;
    }
    /// Returns the log likelihood of all targets at some points. Counts are independent of all other targets.
    [[nodiscard]] std::vector<double> log_likelihood(stats::Rows points) const {
        std::vector<double> total(points.size(), 0);
        const auto predictions = predict(points);
        const auto numbers = modelled();
        std::vector<stats::Target> values;
        std::vector<MeasuredTarget> measurements;
        std::vector<std::vector<stats::Prediction>> predicted_values;
        const auto add = [&](const std::vector<double>& logs) {
            for (std::size_t i = 0; i < total.size(); ++i) total[i] += logs[i];
        };
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            const auto& target = result_.targets[numbers[k]];
            if (target.of) {
                add(stats::log_likelihood_of_count(counted(numbers[k]), predictions[k]));
                continue;
            }
            values.push_back(measured(numbers[k]));
            measurements.push_back(target);
            predicted_values.push_back(predictions[k]);
        }
        if (!values.empty()) add(stats::log_likelihood(values, predicted_values, covariance_of(measurements)));
        return total;
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
        const auto box = even_points(request_, result_.factors, count, stream);
        for (std::size_t i = 0; i < box.size(); i += d_)
            if (admitted(std::span(box).subspan(i, d_))) append(all.points, box, i / d_);
        for (const double weight : result_.answering.log_weights({all.points, d_}))
            all.answers.push_back(weight > -std::numeric_limits<double>::infinity());
        const auto predictions = predict({all.points, d_});
        const auto targets = modelled();
        std::vector<std::vector<double>> implausibilities;
        for (std::size_t k = 0; k < targets.size(); ++k)
            implausibilities.push_back(implausible(targets[k], predictions[k]));
        all.implausibility = stats::deciding_implausibility(implausibilities);
        for (std::size_t i = 0; i < all.implausibility.size(); ++i) {
            if (!(all.implausibility[i] < ruled_out) || !all.answers[i]) continue;
            all.kept.push_back(i);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const auto& p = predictions[k][i];
                all.sure = all.sure && p.mean_error * p.mean_error < other_variance(targets[k], p);
            }
        }
        return all;
    }

    /// Returns the next settings; none: the waves end. After a check without a miss only their number ends them.
    std::vector<double> next(std::int64_t wave, bool missed) {
        auto& now = result_.waves.back();
        if (const auto target = unanswered(); target && !modelled().empty()) {
            now.kept = result_.waves.size() > 1 ? result_.waves[result_.waves.size() - 2].kept : 1;
            const auto& silent = result_.targets[*target];
            return fail("no case has an answer to " + (silent.experiment.empty() ? "" : silent.experiment + '/') +
                        silent.shown_observable());
        }
        if (modelled().empty()) {
            now.kept = result_.waves.size() > 1 ? result_.waves[result_.waves.size() - 2].kept : 1;
            if (wave == request_.count("waves")) return fail("the waves asked for are done, and no target has a model");
            return even_points(request_, result_.factors, request_.count("points_per_wave"),
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
        stats::PosteriorSettings settings;
        settings.seed = draw_key(request_.seed, DrawPurpose::calibration, stream, 1);
        auto sample = stats::sample_posterior(
            [&](stats::Rows drawn) {
                const auto middles = in_the_middle(result_.factors, {drawn.values.begin(), drawn.values.end()});
                const stats::Rows points{middles, d_};
                auto density = log_likelihood(points);
                const auto weights = result_.answering.log_weights(points);
                for (std::size_t i = 0; i < density.size(); ++i)
                    density[i] =
                        admitted(points.row(i)) ? density[i] + weights[i] : -std::numeric_limits<double>::infinity();
                return density;
            },
            {best_, d_}, settings);
        if (shape != nullptr) *shape = stats::posterior_shape(sample.rows());  // before levels lose their width
        sample.points = in_the_middle(result_.factors, std::move(sample.points));
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
        for (std::size_t j = 0; j < factors.size(); ++j) add_inputs(inputs.values, factors[j], points.row(i)[j]);
    if (points.size() > 0) inputs.width = inputs.values.size() / points.size();
    return inputs;
}

Calibration calibration_of(const DesignRequest& request) {
    return Course(request).run();
}

DesignInfo calibration_design() {
    using Kind = Field::Kind;
    constexpr Interval share{0, 1};
    const auto points = [](const DesignRequest& request) {
        return request.grown ? *request.grown : calibration_of(request).points;
    };
    return {
        .name = "calibration",
        .summary = "Waves of points that close in on the settings which reproduce what was measured: history matching.",
        .options =
            {{needed({"targets", Kind::word, "what was measured"})},
             {needed({"experiment", Kind::word, "of several that share the waves, the one that this campaign runs"})},
             {needed({"together", Kind::word, "the factors that those experiments calibrate together"})},
             {count_field("waves", 1, 100, "4", "waves at most")},
             {count_field("points_per_wave", 1, 1e4, "40", "settings of a wave; each is run under every condition")},
             {count_field("checks", 1, 1000, "8", "settings drawn from the posterior that are run to check it")},
             {{"shrink", Kind::number, "the waves end when one rules out less than this share of what was kept", "0.02",
               share}}},
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
