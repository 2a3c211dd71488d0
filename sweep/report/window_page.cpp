#include "sweep/report/window_page.hpp"

#include "sweep/report/model_tables.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/factor_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <ostream>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t points_of_curve = 41;

struct FactorCurve {
    std::vector<double> at;
    std::vector<Judgement> judged;
};

FactorCurve curve_through(const ModelCases& cases, const WindowRequest& request, const Window& window,
                          const Admits& admits, const Setting& centre, std::size_t factor) {
    FactorCurve curve{points_along(cases.factors[factor], points_of_curve), {}};
    std::vector<Setting> settings(curve.at.size(), centre);
    for (std::size_t i = 0; i < settings.size(); ++i) place(cases.factors, settings[i], factor, curve.at[i]);
    curve.judged = judge_settings(cases, request, window, admits, settings);
    return curve;
}

double width_of(std::span<const Judgement> judged, double (*of)(const Judgement&)) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& one : judged) {
        low = std::min(low, of(one));
        high = std::max(high, of(one));
    }
    return high > low ? high - low : 0;
}

/// Whether the first objective is an observable.
bool modelled_objective(const Window& window) {
    return !window.goals.empty() && window.goals.front().model;
}

std::string name_of(const Goal& goal, const ModelCases& cases, const Window& window) {
    return goal.model ? window.models[*goal.model].observable : cases.factors[*goal.factor].name;
}

double probability_of(const Judgement& one) {
    return one.probability;
}
double objective_of(const Judgement& one) {
    return one.objectives.front().mean;
}

/// Returns the variance of the means of `values` in groups by a factor: eight groups of equal count, or the factor's
/// values if there are at most eight. 0 if no point has a value of the factor.
double variance_by(std::span<const Setting> settings, std::span<const double> values, std::size_t factor) {
    constexpr std::size_t most_groups = 8;
    struct Group {
        double sum = 0;
        std::size_t count = 0;
    };
    std::map<double, Group> by_value;
    double mean = 0;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (std::isnan(settings[i][factor])) return 0;
        auto& group = by_value[settings[i][factor]];
        group.sum += values[i];
        ++group.count;
        mean += values[i] / static_cast<double>(values.size());
    }
    const auto least = by_value.size() <= most_groups ? 1 : settings.size() / most_groups;
    double variance = 0;
    Group group;
    for (const auto& [value, one] : by_value) {
        group.sum += one.sum;
        group.count += one.count;
        if (group.count < least) continue;
        const double off = group.sum / static_cast<double>(group.count) - mean;
        variance += off * off * static_cast<double>(group.count) / static_cast<double>(values.size());
        group = {};
    }
    return variance;
}

/// Orders factors by their effect on the condition in the whole box; the factors of a map come first.
void put_decisive_first(std::vector<std::size_t>& order, const ModelCases& cases, const WindowRequest& request,
                        const Window& window, const Admits& admits) {
    constexpr std::size_t most_points = 1024;  // of the searched ones, which are a Sobol sequence
    if (request.where.empty()) return;
    const auto settings = std::span(window.searched).first(std::min(most_points, window.searched.size()));
    std::vector<double> probabilities;
    for (const auto& one : judge_settings(cases, request, window, admits, settings))
        probabilities.push_back(one.probability);
    std::vector<double> weights;
    for (std::size_t j = 0; j < cases.factors.size(); ++j) weights.push_back(variance_by(settings, probabilities, j));
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j]; });
}

/// Factors by how much they matter, see the header.
std::vector<std::size_t> order_of(std::span<const FactorCurve> curves, bool objective, double whole_range) {
    std::vector<double> weights;
    for (const auto& curve : curves) {
        double weight = width_of(curve.judged, probability_of);
        if (objective && whole_range > 0) weight += width_of(curve.judged, objective_of) / whole_range;
        weights.push_back(weight);
    }
    std::vector<std::size_t> order(curves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j]; });
    return order;
}

Json responses_of(const Window& window, const Judgement& one) {
    Json list = Json::array();
    for (std::size_t k = 0; k < window.models.size(); ++k) {
        const auto& p = one.predictions[k];
        const auto shown = [&](double x) { return one.believed ? Json(x) : Json(); };
        list.push_back({{"mean", shown(p.mean)},
                        {"mean_half_width", shown(p.mean_half_width())},
                        {"run_half_width", shown(p.run_half_width())}});
    }
    return list;
}

Json window_page_json(const ModelCases& cases, const Window& window, const Judgement& one) {
    Json texts = Json::array();
    for (std::size_t j = 0; j < cases.factors.size(); ++j) texts.push_back(cases.factors[j].text(one.setting[j]));
    return {{"setting", one.setting},
            {"texts", texts},
            {"probability", one.probability},
            {"responses", responses_of(window, one)}};
}

Json window_page_json(const Window& window, const FactorCurve& curve) {
    return {{"at", curve.at},
            {"probability", Json::list(curve.judged, probability_of)},
            {"responses", Json::list(curve.judged, [&](const auto& one) { return responses_of(window, one); })}};
}

Json map_of(const ModelCases& cases, const WindowRequest& request, const Window& window, const Admits& admits,
            const Setting& centre, std::size_t a, std::size_t b) {
    const auto settings = settings_of_map(cases.factors, centre, a, b, points_of_curve);
    const auto judged = judge_settings(cases, request, window, admits, settings);
    const bool modelled = modelled_objective(window);
    Json probability = Json::array(), objective = modelled ? Json::array() : Json();
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const bool there = !admits || admits(settings[i]);
        probability.push_back(there ? Json(judged[i].probability) : Json());
        const bool answers = there && judged[i].believed;
        if (modelled) objective.push_back(answers ? Json(judged[i].objectives.front().mean) : Json());
    }
    return map_json(cases.factors, a, b, points_of_curve).add({{"probability", probability}, {"objective", objective}});
}

}  // namespace

Json window_page_data(const ModelCases& cases, const WindowRequest& request, const Window& window,
                      const Admits& admits) {
    const auto& centre = window.best ? *window.best : window.surest.value();
    std::vector<FactorCurve> curves;
    for (std::size_t j = 0; j < cases.factors.size(); ++j)
        curves.push_back(curve_through(cases, request, window, admits, centre.setting, j));
    const bool objective = !request.objectives.empty(), modelled = modelled_objective(window);
    double whole_range = 0;
    if (modelled) {
        const auto& model = window.models.front();
        const auto means = model.means(model.case_features);
        const auto [low, high] = std::ranges::minmax(means);
        whole_range = high - low;
    }
    auto order = order_of(curves, modelled, whole_range);
    put_decisive_first(order, cases, request, window, admits);
    Json responses = Json::array();
    for (const auto& model : window.models) responses.push_back({{"name", model.observable}, {"unit", model.unit}});
    const auto settings = [&](const std::vector<Judgement>& judged) {
        return Json::list(judged, [&](const Judgement& one) { return window_page_json(cases, window, one); });
    };
    const Json map =
        order.size() < 2 ? Json() : map_of(cases, request, window, admits, centre.setting, order[0], order[1]);
    return {{"campaigns", std::array{Json{{"name", cases.campaign.name}}}},
            {"campaign", cases.campaign.name},
            {"scene", shown_scene(cases.campaign.scene)},
            {"where", request.where},
            {"objective", objective ? Json(request.objectives.front().name) : Json()},
            {"goal", goal_text(request)},
            {"volume", window.volume ? Json(volume_text(*window.volume)) : Json()},
            {"single_run", request.judged == stats::Judged::single_run},
            {"risk", request.risk},
            {"share", window.share_of_box},
            {"share_error", window.share_error},
            {"share_of", share_of(cases.factors)},
            {"factors", axes_json(cases.factors)},
            {"meets", window.best.has_value()},
            {"best", window_page_json(cases, window, centre)},
            {"failed", failed_json(cases)},
            {"failed_near", cases.failed.empty() ? "" : near_text(cases, window.answers->near(centre.setting))},
            {"order", order},
            {"responses", responses},
            {"models", Json::list(window.models, model_lines)},
            {"curves", Json::list(curves, [&](const FactorCurve& curve) { return window_page_json(window, curve); })},
            {"map", map},
            {"front", settings(window.front)},
            {"next", settings(window.next)},
            {"against", window.against ? Json(name_of(*window.against, cases, window)) : Json()},
            {"notes", window.notes}};
}

void write_window_page(std::ostream& out, const Json& data, std::string_view database) {
    Json all = data;
    all.add("databases", std::array{database});
    write_figures(out, page_files().window, safe_in_script(all));
}

}  // namespace grainsweep::report
