#include "sweep/study/window_question.hpp"

#include "stats/confidence.hpp"
#include "sweep/campaign/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainsweep::study {
namespace {

constexpr std::size_t settings_at_once = 4096, settings_of_a_step = 256;

bool is_finite(const Judgement& one) {
    return std::ranges::all_of(one.predictions,
                               [](const auto& p) { return std::isfinite(p.mean) && std::isfinite(p.mean_error); });
}

/// The prediction if the mean is known to be `end`, with the least scatter: the share may be so large.
stats::Prediction known_mean(stats::Prediction p, double end, double narrowest) {
    p.mean_error = 0;
    p.scatter *= narrowest;
    p.even_scatter = std::numeric_limits<double>::quiet_NaN();
    p.mean = end;
    if (p.latent) p.latent = {stats::normal_quantile(std::clamp(end, 1e-12, 1 - 1e-12)), 0};
    return p;
}

/// Mean over settings of one weight, see the header.
stats::Prediction mean_prediction(std::span<const Judgement> behind, std::size_t model) {
    const auto n = static_cast<double>(behind.size());
    stats::Prediction sum{.mean = 0, .mean_error = 0, .scatter = 0};
    double squares = 0, even = 0;
    for (const auto& one : behind) {
        const auto& p = one.predictions[model];
        sum.mean += p.mean / n;
        sum.mean_error += p.mean_error / n;
        sum.inside = sum.inside && p.inside;
        sum.freedom = p.freedom;
    }
    for (const auto& one : behind) {
        const auto& p = one.predictions[model];
        const double moved = (p.mean - sum.mean) * (p.mean - sum.mean);
        squares += (p.scatter * p.scatter + moved) / n;
        even += (p.even_scatter * p.even_scatter + moved) / n;
    }
    sum.scatter = std::sqrt(squares);
    sum.even_scatter = std::sqrt(even);
    return sum;
}

}  // namespace

WindowQuestion::WindowQuestion(const ModelCases& cases, const WindowRequest& request, Admits admits,
                               std::span<const ObservableModel> learned, std::shared_ptr<const Answers> answers)
    : cases_(&cases),
      request_(&request),
      stated_(split_condition(request.where)),
      space_(cases, request.held, stated_.for_all, std::move(admits)),
      answers_(answers ? std::move(answers) : std::make_shared<const Answers>(cases)) {
    names_ = cases.observable_names();
    for (const auto& name : cases.factor_names()) names_.push_back(name);
    std::vector<std::string> units;
    for (const auto& observable : cases.observables) units.push_back(observable.unit);
    for (const auto& factor : cases.factors) units.push_back(factor.unit);
    if (!stated_.condition.empty()) condition_ = Condition::read(stated_.condition, names_, units);
    if (request.objectives.size() == 2 && request.objectives[0].name == request.objectives[1].name)
        throw campaign::input_error("--minimize", request.objectives[1].name, "is named twice: one goal for each");
    for (const auto& objective : request.objectives) goals_.push_back(goal_of(objective, learned));
    if (goals_.size() == 2) find_references();
    if (condition_)
        for (const auto name : condition_->compared())
            if (name < cases.observables.size()) (void)add_model(name, learned);
    if (models_.empty()) return;
    std::vector<double> freedom;
    std::vector<std::vector<double>> scores;
    for (const auto& model : models_) {
        freedom.push_back(model.freedom());
        if (request.judged == stats::Judged::single_run) scores.push_back(model.scores());
    }
    errors_.emplace(freedom, scores);
}

/// An observable goes before a factor of the same name, as in the condition.
Goal WindowQuestion::goal_of(const Objective& objective, std::span<const ObservableModel> learned) {
    const auto& name = objective.name;
    const double sign = objective.maximise ? 1 : -1;
    const auto place = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
    const auto observables = cases_->observables.size();
    if (place < observables) return {.sign = sign, .factor = {}, .model = add_model(place, learned)};
    const auto* const option = objective.maximise ? "--maximize" : "--minimize";
    if (place == names_.size())
        throw campaign::input_error(option, name, "is neither observable nor factor of the campaign",
                                    campaign::nearest_word(name, names_));
    if (cases_->factors[place - observables].is_word())
        throw campaign::input_error(option, name, "is a factor whose levels are words: none is the largest");
    if (!condition_ && request_->objectives.size() == 1)
        throw campaign::input_error(option, name, "is a factor: it needs a condition by --where that limits it");
    if (!space_.searches(place - observables))
        throw campaign::input_error(option, name, "is not searched: it is noise, held, or named by 'for all'");
    return {.sign = sign, .factor = place - observables, .model = {}};
}

std::vector<double> WindowQuestion::values_of(const Goal& goal) const {
    if (goal.model) return cases_->observables[name_of_model_[*goal.model]].values;
    std::vector<double> values;
    for (const auto& setting : cases_->settings) values.push_back(setting[*goal.factor]);
    return values;
}

void WindowQuestion::find_references() {
    if (goals_[0].factor && goals_[1].factor)
        throw campaign::input_error("window", request_->objectives[1].name,
                                    "is a factor like the first objective: one of two is an observable");
    for (std::size_t k = 0; k < goals_.size(); ++k) {
        auto& goal = goals_[k];
        double worst = std::numeric_limits<double>::infinity();
        for (const double x : values_of(goal))
            if (std::isfinite(x)) worst = std::min(worst, goal.sign * x);
        goal.reference = request_->objectives[k].reference.value_or(goal.sign * worst);
    }
}

std::size_t WindowQuestion::add_model(std::size_t name, std::span<const ObservableModel> learned) {
    if (const auto found = std::ranges::find(name_of_model_, name); found != name_of_model_.end())
        return static_cast<std::size_t>(found - name_of_model_.begin());
    const auto& column = cases_->observables[name];
    const auto known = std::ranges::find(learned, column.name, &ObservableModel::observable);
    if (known == learned.end()) report("model of " + column.name, 0);
    models_.push_back(known != learned.end() ? *known : learn_or_refuse(*cases_, column, Unexplained::scatter));
    name_of_model_.push_back(name);
    return models_.size() - 1;
}

void WindowQuestion::add_objectives(Judgement& one) const {
    for (const auto& goal : goals_)
        one.objectives.push_back(
            goal.model ? one.predictions[*goal.model]
                       : stats::Prediction{.mean = one.setting[*goal.factor], .mean_error = 0, .scatter = 0});
}

std::vector<Judgement> WindowQuestion::judge(std::span<const Setting> settings, std::string_view step,
                                             std::size_t doubted) const {
    if (step.empty()) return judge_by(models_, settings, doubted);
    std::vector<Judgement> judged;
    for (std::size_t from = 0; from < settings.size(); from += settings_of_a_step) {
        report(step, static_cast<double>(from) / static_cast<double>(settings.size()));
        const auto some = settings.subspan(from, std::min(settings_of_a_step, settings.size() - from));
        std::ranges::move(judge_by(models_, some, doubted > from ? doubted - from : 0), std::back_inserter(judged));
    }
    report(step, 1);
    return judged;
}

std::vector<Judgement> WindowQuestion::judge_by(std::span<const ObservableModel> by, std::span<const Setting> settings,
                                                std::size_t doubted) const {
    if (!space_.averages()) return judge_each(by, settings, doubted);
    std::vector<Judgement> judged;
    std::vector<Setting> behind;
    std::vector<std::vector<std::size_t>> sizes;
    const auto judge_those = [&] {
        const auto each = judge_each(by, behind, judged.size() < doubted ? behind.size() : 0);
        std::size_t from = 0;
        for (const auto& of_one : sizes) {
            const auto count = std::accumulate(of_one.begin(), of_one.end(), std::size_t{0});
            judged.push_back(averaged(settings[judged.size()], of_one, std::span(each).subspan(from, count)));
            from += count;
        }
        behind.clear();
        sizes.clear();
    };
    for (const auto& setting : settings) {
        auto& of_one = sizes.emplace_back();
        for (auto& group : space_.behind(setting)) {
            of_one.push_back(group.size());
            std::ranges::move(group, std::back_inserter(behind));
        }
        if (behind.size() >= settings_at_once) judge_those();
    }
    judge_those();
    return judged;
}

std::vector<Judgement> WindowQuestion::judge_each(std::span<const ObservableModel> by,
                                                  std::span<const Setting> settings, std::size_t doubted) const {
    std::vector<Judgement> judged(settings.size());
    const auto answers = answers_->at(settings);
    for (std::size_t i = 0; i < settings.size(); ++i) {
        judged[i].setting = settings[i];
        judged[i].answers = answers[i].probability;
        judged[i].answers_low = answers[i].low;
        judged[i].answers_high = answers[i].high;
    }
    for (const auto& model : by) {
        const auto predictions = model.predict(settings);
        const auto defined = model.defined(settings);
        for (std::size_t i = 0; i < settings.size(); ++i) {
            judged[i].predictions.push_back(predictions[i]);
            judged[i].defined.push_back(defined[i]);
        }
    }
    for (auto& one : judged) {
        const bool known = is_finite(one) && std::isfinite(one.answers);
        one.believed = known && one.answers >= 0.5;
        one.probability = known ? one.answers * probability(one) : 0;
        add_objectives(one);
    }
    for (auto& one : std::span(judged).first(std::min(doubted, judged.size()))) add_ends(one);
    return judged;
}

void WindowQuestion::add_ends(Judgement& one) const {
    const bool known = is_finite(one) && std::isfinite(one.answers);
    for (std::size_t k = 0; k < one.predictions.size(); ++k) {
        const auto predicted = one.predictions[k];
        for (const double end : {predicted.mean_low(), predicted.mean_high()}) {
            one.predictions[k] = known_mean(predicted, end, errors_->narrowest(k));
            one.at_ends.push_back(known ? one.answers * probability(one) : 0);
        }
        one.predictions[k] = predicted;
    }
}

Judgement WindowQuestion::averaged(const Setting& setting, std::span<const std::size_t> sizes,
                                   std::span<const Judgement> behind) const {
    Judgement one{.setting = setting, .predictions = {}, .defined = {}, .probability = 1};
    std::size_t from = 0;
    for (const auto size : sizes) {
        const auto group = behind.subspan(from, size);
        from += size;
        if (size == 0) continue;
        double probability = 0, answers = 0, low = 0, high = 0;
        std::vector<double> ends(group.front().at_ends.size(), 0);
        for (const auto& each : group) {
            probability += each.probability / static_cast<double>(size);
            answers += each.answers / static_cast<double>(size);
            low += each.answers_low / static_cast<double>(size);
            high += each.answers_high / static_cast<double>(size);
            for (std::size_t e = 0; e < ends.size(); ++e) ends[e] += each.at_ends[e] / static_cast<double>(size);
        }
        if (one.at_ends.empty()) one.at_ends = ends;
        for (std::size_t e = 0; e < ends.size(); ++e) one.at_ends[e] = std::min(one.at_ends[e], ends[e]);
        one.probability = std::min(one.probability, probability);
        one.answers = std::min(one.answers, answers);
        one.answers_low = std::min(one.answers_low, low);
        one.answers_high = std::min(one.answers_high, high);
    }
    for (std::size_t k = 0; k < models_.size(); ++k) {
        one.predictions.push_back(mean_prediction(behind, k));
        double defined = 0;
        for (const auto& each : behind) defined += each.defined[k] / static_cast<double>(behind.size());
        one.defined.push_back(defined);
    }
    one.believed = !behind.empty() && is_finite(one) && one.answers >= 0.5;
    if (behind.empty()) one.probability = 0;
    add_objectives(one);
    return one;
}

Setting WindowQuestion::least_known(std::span<const ObservableModel> by, const Setting& setting) const {
    if (!space_.averages()) return setting;
    std::vector<Setting> all;
    for (auto& group : space_.behind(setting)) std::ranges::move(group, std::back_inserter(all));
    const auto judged = judge_each(by, all, 0);
    const auto unknown = [&](const Judgement& one) {
        return by.empty() ? -std::abs(one.probability - 0.5) : one.predictions.front().mean_error;
    };
    const auto found = std::ranges::max_element(judged, {}, unknown);
    return found == judged.end() ? setting : found->setting;
}

bool WindowQuestion::better(const Judgement& a, const Judgement& b) const {
    const bool a_meets = meets(a), b_meets = meets(b);
    if (a_meets != b_meets) return a_meets;
    if (a.believed != b.believed) return a.believed;
    const bool a_sure = a.answers_low >= 1 - request_->risk, b_sure = b.answers_low >= 1 - request_->risk;
    if (a_sure != b_sure) return a_sure;
    if (!a_meets || goals_.empty()) return a.probability > b.probability;
    return worth(a) > worth(b);
}

double WindowQuestion::worth(const Judgement& one) const {
    const auto cautious = [&](std::size_t k) {
        return goals_[k].sign * one.objectives[k].mean - one.objectives[k].mean_error;
    };
    if (goals_.size() == 1) return cautious(0);
    double product = 1;
    for (std::size_t k = 0; k < goals_.size(); ++k)
        product *= std::max(0.0, cautious(k) - goals_[k].sign * goals_[k].reference);
    return product;
}

double WindowQuestion::probability_given(const Judgement& one, std::size_t undefined) const {
    for (const auto& goal : goals_)
        if (goal.model && (undefined >> *goal.model & 1U) != 0) return 0;
    if (!condition_) return 1;
    std::vector<double> values(names_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t j = 0; j < one.setting.size(); ++j) values[cases_->observables.size() + j] = one.setting[j];
    const auto holds = [&](std::span<const double> responses) {
        for (std::size_t k = 0; k < responses.size(); ++k)
            values[name_of_model_[k]] =
                (undefined >> k & 1U) != 0 ? std::numeric_limits<double>::quiet_NaN() : responses[k];
        return condition_->holds(values);
    };
    if (models_.empty()) return holds({}) ? 1 : 0;  // over factors alone
    std::vector<std::vector<stats::Prediction>> here;
    for (const auto& prediction : one.predictions) here.push_back({prediction});
    return stats::probability_of(here, holds, request_->judged, *errors_).front();
}

double WindowQuestion::probability(const Judgement& one) const {
    const auto& defined = one.defined;
    double sum = 0;
    for (std::size_t undefined = 0; undefined < std::size_t{1} << models_.size(); ++undefined) {
        double weight = 1;
        for (std::size_t k = 0; k < defined.size(); ++k)
            weight *= (undefined >> k & 1U) != 0 ? 1 - defined[k] : defined[k];
        if (weight > 0) sum += weight * probability_given(one, undefined);
    }
    return sum;
}

}  // namespace grainsweep::study
