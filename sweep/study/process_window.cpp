#include "sweep/study/process_window.hpp"

#include "sweep/campaign/stored_text.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace grainsweep::study {
namespace {

constexpr std::size_t candidates_of_next = 192, points_of_front = 12;
constexpr std::size_t points_about_best = 64, rounds_about_best = 8;
constexpr double first_reach = 0.15;

/// Condition, objective and models of one question; names are observables, then factors.
class Question {
public:
    /// `learned`: models that are there already.
    Question(const ModelCases& cases, const WindowRequest& request, std::span<const ObservableModel> learned = {})
        : cases_(&cases), request_(&request), learned_(learned), near_(cases) {
        names_ = cases.observable_names();
        for (const auto& name : cases.factor_names()) names_.push_back(name);
        if (!request.where.empty()) condition_ = Condition::read(request.where, names_);
        if (!request.objective.empty()) find_objective();
        if (condition_)
            for (const auto name : condition_->compared())
                if (name < cases.observables.size()) add_model(name);
        if (models_.empty()) return;
        std::vector<double> freedom;
        for (const auto& model : models_) freedom.push_back(model.model.freedom());
        errors_.emplace(freedom);
    }

    [[nodiscard]] std::vector<Judgement> judge(std::span<const Setting> settings) const {
        return judge_by(models_, settings);
    }

    /// What the models in `by`, in the order of models(), say of settings.
    [[nodiscard]] std::vector<Judgement> judge_by(std::span<const ObservableModel> by,
                                                  std::span<const Setting> settings) const {
        std::vector<Judgement> judged(settings.size());
        for (std::size_t i = 0; i < settings.size(); ++i) judged[i].setting = settings[i];
        for (const auto& model : by) {
            const auto predictions = model.predict(settings);
            const auto defined = model.defined(settings);
            for (std::size_t i = 0; i < settings.size(); ++i) {
                judged[i].predictions.push_back(predictions[i]);
                judged[i].defined.push_back(defined[i]);
            }
        }
        for (auto& one : judged) {
            one.near = near_.at(one.setting);
            one.believed = one.near.answers && std::ranges::all_of(one.predictions, [](const auto& p) {
                               return std::isfinite(p.mean) && std::isfinite(p.mean_error);
                           });
            one.probability = one.believed ? probability(one) : 0;
            if (factor_)
                one.objective = {.mean = one.setting[*factor_], .mean_error = 0, .scatter = 0};
            else if (modelled_objective())
                one.objective = one.predictions.front();
        }
        return judged;
    }

    /// Whether `a` is the better answer: the objective where the condition is met surely enough, else the probability.
    /// A setting beside the border to failed cases (stats/nearest_cases.hpp) comes after all others.
    [[nodiscard]] bool better(const Judgement& a, const Judgement& b) const {
        const bool a_meets = meets(a), b_meets = meets(b);
        if (a_meets != b_meets) return a_meets;
        if (a.believed != b.believed) return a.believed;
        if (a.near.beside != b.near.beside) return b.near.beside;
        if (!a_meets || request_->objective.empty()) return a.probability > b.probability;
        return cautious(a) > cautious(b);
    }
    /// The objective less one standard error: the largest mean alone is as often an error as a peak.
    [[nodiscard]] double cautious(const Judgement& one) const {
        return (request_->maximise ? 1 : -1) * one.objective.mean - one.objective.mean_error;
    }
    [[nodiscard]] bool meets(const Judgement& one) const { return one.probability >= 1 - request_->risk; }

    [[nodiscard]] const std::optional<Condition>& condition() const { return condition_; }
    [[nodiscard]] const std::vector<ObservableModel>& models() const { return models_; }
    [[nodiscard]] std::size_t name_of_model(std::size_t model) const { return name_of_model_[model]; }
    [[nodiscard]] bool objective_is_factor() const { return factor_.has_value(); }
    /// The objective is an observable: that of the first model.
    [[nodiscard]] bool modelled_objective() const { return !request_->objective.empty() && !factor_; }

private:
    /// An observable goes before a factor of the same name, as in the condition.
    void find_objective() {
        const auto& name = request_->objective;
        const auto place = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
        const auto observables = cases_->observables.size();
        if (place < observables) return add_model(place);
        const auto* const option = request_->maximise ? "--maximize" : "--minimize";
        if (place == names_.size())
            throw campaign::wrong_question(option, name, "is neither observable nor factor of the campaign",
                                           campaign::nearest_word(name, names_));
        if (cases_->factors[place - observables].is_word())
            throw campaign::wrong_question(option, name, "is a factor whose levels are words: none is the largest");
        if (!condition_)
            throw campaign::wrong_question(option, name, "is a factor: it needs a condition by --where that limits it");
        factor_ = place - observables;
    }

    void add_model(std::size_t name) {
        if (std::ranges::find(name_of_model_, name) != name_of_model_.end()) return;
        const auto& column = cases_->observables[name];
        const auto known = std::ranges::find(learned_, column.name, &ObservableModel::observable);
        models_.push_back(known != learned_.end() ? *known : learn_or_refuse(*cases_, column));
        name_of_model_.push_back(name);
    }

    /// P(condition and objective defined | those of the mask undefined).
    [[nodiscard]] double probability_given(const Judgement& one, std::size_t undefined) const {
        const bool objective_lost = modelled_objective() && (undefined & 1U) != 0;
        if (objective_lost) return 0;
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

    [[nodiscard]] double probability(const Judgement& one) const {
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

    const ModelCases* cases_;
    const WindowRequest* request_;
    std::span<const ObservableModel> learned_;
    CasesNear near_;
    std::vector<std::string> names_;
    std::optional<Condition> condition_;
    std::optional<std::size_t> factor_;  ///< the objective, where it is one
    std::vector<ObservableModel> models_;
    std::vector<std::size_t> name_of_model_;
    std::optional<stats::SampledErrors> errors_;  ///< none: there is no model
};

/// The best of the judged points, improved by points about it.
std::pair<Judgement, std::vector<Judgement>> improved(const Question& question, const ModelCases& cases,
                                                      const Admits& admits, std::span<const BoxPoint> points,
                                                      std::span<const Judgement> judged) {
    std::size_t start = 0;
    for (std::size_t i = 1; i < judged.size(); ++i)
        if (question.better(judged[i], judged[start])) start = i;
    BoxPoint centre = points[start];
    Judgement best = judged[start];
    std::vector<Judgement> seen;
    double reach = first_reach;
    for (std::size_t round = 0; round < rounds_about_best; ++round, reach /= 2) {
        const auto near = points_about(centre, reach, cases.factors, admits, points_about_best);
        std::vector<Setting> settings;
        for (const auto& point : near) settings.push_back(point.setting);
        auto judgements = question.judge(settings);
        for (std::size_t i = 0; i < near.size(); ++i) {
            if (!question.better(judgements[i], best)) continue;
            best = judgements[i];
            centre = near[i];
        }
        std::ranges::move(judgements, std::back_inserter(seen));
    }
    return {std::move(best), std::move(seen)};
}

/// Trade-off of the objective and the first other observable that the condition bounds from one side.
void find_front(Window& window, const Question& question, const WindowRequest& request,
                std::span<const Judgement> judged) {
    if (request.objective.empty() || !question.condition()) return;
    int direction = 0;
    const std::size_t others = question.modelled_objective() ? 1 : 0;
    for (std::size_t k = others; k < window.models.size() && direction == 0; ++k) {
        direction = question.condition()->direction(question.name_of_model(k));
        if (direction != 0) window.against = k;
    }
    if (!window.against) return;
    window.against_maximised = direction > 0;
    std::vector<double> first, second;
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < judged.size(); ++i) {
        const auto& defined = judged[i].defined;
        if (!judged[i].believed || std::min(defined.front(), defined[*window.against]) < 1 - request.risk) continue;
        usable.push_back(i);
        first.push_back(judged[i].objective.mean);
        second.push_back(judged[i].predictions[*window.against].mean);
    }
    const auto front = stats::trade_off_front(first, request.maximise, second, window.against_maximised);
    const auto shown = std::min(front.size(), points_of_front);
    for (std::size_t k = 0; k < shown; ++k) {
        const auto place = shown == 1 ? 0 : (k * (front.size() - 1) + (shown - 1) / 2) / (shown - 1);
        window.front.push_back(judged[usable[front[place]]]);
    }
}

/// P (x_j - x_j*) of the header; where nothing is in the window yet, P.
std::vector<double> gains_of_factor(const Question& question, std::span<const Judgement> judged, double sign) {
    std::optional<double> best;
    for (const auto& one : judged)
        if (question.meets(one)) best = std::max(best.value_or(sign * one.objective.mean), sign * one.objective.mean);
    std::vector<double> gain;
    for (const auto& one : judged)
        gain.push_back(one.probability * (best ? std::max(sign * one.objective.mean - *best, 0.0) : 1));
    return gain;
}

std::vector<double> gains(const Question& question, std::span<const Judgement> judged, const WindowRequest& request) {
    if (question.objective_is_factor()) return gains_of_factor(question, judged, request.maximise ? 1 : -1);
    std::vector<stats::Prediction> objective;
    std::vector<double> probability;
    for (const auto& one : judged) {
        probability.push_back(one.probability);
        if (!request.objective.empty()) objective.push_back(one.objective);
    }
    if (!objective.empty()) return stats::expected_improvement(objective, probability, request.maximise);
    for (double& p : probability) p = std::min(p, 1 - p);  // where the condition is least decided
    return probability;
}

/// Cases to run next: the largest gain, added to the models with its predicted responses, then the next.
std::vector<Judgement> next_of(const Question& question, const WindowRequest& request, std::vector<Judgement> judged) {
    std::erase_if(judged, [](const auto& one) { return !one.believed; });
    auto gain = gains(question, judged, request);
    std::vector<std::size_t> order(judged.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
    order.resize(std::min(order.size(), std::max(candidates_of_next, 4 * request.next)));
    std::vector<Setting> settings;
    for (const auto i : order) settings.push_back(judged[i].setting);

    auto models = question.models();
    std::vector<Judgement> chosen;
    std::set<Setting> taken;
    while (chosen.size() < request.next) {
        const auto now = question.judge_by(models, settings);
        gain = gains(question, now, request);
        for (std::size_t i = 0; i < now.size(); ++i)
            if (taken.contains(settings[i])) gain[i] = 0;
        const auto best = static_cast<std::size_t>(std::ranges::max_element(gain) - gain.begin());
        if (gain.empty() || !(gain[best] > 0)) break;
        taken.insert(settings[best]);
        for (std::size_t k = 0; k < models.size(); ++k) {
            const auto row = models[k].rows(std::span(&settings[best], 1));
            models[k].model =
                models[k].model.with_cases({row, row.size()}, std::span(&now[best].predictions[k].mean, 1));
        }
        chosen.push_back(question.judge(std::span(&settings[best], 1)).front());
    }
    return chosen;
}

/// What the failed cases mean for the window and the chosen setting.
void say_what_failed(Window& window, const ModelCases& cases) {
    if (cases.failed.empty()) return;
    window.notes.push_back(
        fmt::format("{}; the nearest cases failed in {:.1f} % of the box, where no setting is counted or recommended",
                    failed_text(cases), 100 * window.share_failed));
    if (const auto& chosen = window.best ? window.best : window.surest)
        window.notes.push_back(fmt::format("near {} {}",
                                           window.best ? "the best setting" : "where the condition is likeliest",
                                           near_text(cases, chosen->near)));
}

void say_what_was_found(Window& window, const WindowRequest& request) {
    if (!window.best && window.surest)
        window.notes.push_back(fmt::format(
            "the condition holds nowhere with probability {}; where it is most likely it holds with probability {:.3f}",
            1 - request.risk, window.surest->probability));
    if (window.best && !request.objective.empty())
        window.notes.emplace_back(
            "a search favours errors in its favour: run the best setting with several seeds before relying on it");
    for (const auto& model : window.models)
        if (model.undefined > 0)
            window.notes.push_back(
                fmt::format("where '{}' is undefined the condition does not hold; how likely that is comes from where "
                            "cases have it and where not",
                            model.observable));
    if (request.next > window.next.size())
        window.notes.push_back(
            fmt::format("{} of {} next cases: no further one promises anything", window.next.size(), request.next));
}

}  // namespace

Window window_of(const store::Store& store, const ModelCases& cases, const WindowRequest& request) {
    if (request.where.empty() && request.objective.empty())
        throw campaign::wrong_question("window", "", "give a condition by --where, or --maximize or --minimize NAME");
    if (!(request.risk > 0 && request.risk < 1))
        throw campaign::wrong_question("--risk", fmt::format("{}", request.risk), "must lie between 0 and 1");
    const Question question(cases, request);
    const auto admits = admission(store, cases);
    const auto points = spread_points(cases.factors, admits, request.candidates);
    if (points.empty())
        throw campaign::wrong_question("window", "", "the campaign's `where` leaves no setting of the box");
    Window window;
    window.models = question.models();
    window.objective_is_factor = question.objective_is_factor();
    for (const auto& point : points) window.searched.push_back(point.setting);
    auto judged = question.judge(window.searched);

    if (std::ranges::none_of(judged, [](const auto& one) { return one.near.answers; }))
        throw campaign::wrong_question("window", "",
                                       fmt::format("{}, and the nearest cases failed at every setting of the box: none "
                                                   "can be recommended",
                                                   failed_text(cases)));
    const auto n = static_cast<double>(judged.size());
    window.share_failed =
        static_cast<double>(std::ranges::count_if(judged, [](const auto& one) { return !one.near.answers; })) / n;
    window.share_of_box =
        static_cast<double>(std::ranges::count_if(judged, [&](const auto& one) { return question.meets(one); })) / n;
    window.share_error = std::sqrt(window.share_of_box * (1 - window.share_of_box) / n);
    auto [best, seen] = improved(question, cases, admits, points, judged);
    (question.meets(best) ? window.best : window.surest) = best;
    find_front(window, question, request, judged);
    if (request.next > 0) {
        std::ranges::move(seen, std::back_inserter(judged));
        window.next = next_of(question, request, std::move(judged));
    }
    say_what_failed(window, cases);
    say_what_was_found(window, request);
    return window;
}

std::vector<Judgement> judge_settings(const ModelCases& cases, const WindowRequest& request, const Window& window,
                                      std::span<const Setting> settings) {
    return Question(cases, request, window.models).judge(settings);
}

std::string next_campaign(const ModelCases& cases, const Window& window, std::string_view name, std::uint64_t number) {
    std::vector<std::vector<Value>> rows;
    for (const auto& one : window.next) {
        auto& row = rows.emplace_back();
        for (std::size_t j = 0; j < cases.factors.size(); ++j) row.push_back(cases.factors[j].value(one.setting[j]));
    }
    return campaign::further_points(
        campaign::text_of_experiment(cases.campaign.text, cases.campaign), name,
        fmt::format("The cases that the response models of {} promise most of, by grainsweep window --next {}.",
                    cases.campaign.name, rows.size()),
        rows, number);
}

}  // namespace grainsweep::study
