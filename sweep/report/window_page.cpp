#include "sweep/report/window_page.hpp"

#include "sweep/report/model_tables.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/table.hpp"
#include "sweep/study/factor_axis.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>

namespace grainsweep::report {

using namespace study;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t points_of_curve = 41;

struct FactorCurve {
    std::vector<double> at;
    std::vector<Judgement> judged;
};

FactorCurve curve_through(const ModelCases& cases, const WindowRequest& request, const Window& window,
                          const Setting& centre, std::size_t factor) {
    FactorCurve curve{points_along(cases.factors[factor], points_of_curve), {}};
    std::vector<Setting> settings(curve.at.size(), centre);
    for (std::size_t i = 0; i < settings.size(); ++i) settings[i][factor] = curve.at[i];
    curve.judged = judge_settings(cases, request, window, settings);
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

bool modelled_objective(const WindowRequest& request, const Window& window) {
    return !request.objective.empty() && !window.objective_is_factor;
}

double probability_of(const Judgement& one) {
    return one.probability;
}
double objective_of(const Judgement& one) {
    return one.objective.mean;
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
        const auto shown = [&](double x) { return one.believed ? json_number(x) : Json(nullptr); };
        list.push_back({{"mean", shown(p.mean)},
                        {"mean_half_width", shown(p.mean_half_width())},
                        {"run_half_width", shown(p.run_half_width())}});
    }
    return list;
}

Json json_of(const ModelCases& cases, const Window& window, const Judgement& one) {
    Json value = {{"setting", Json::array()}, {"texts", Json::array()}};
    for (std::size_t j = 0; j < cases.factors.size(); ++j) {
        value["setting"].push_back(one.setting[j]);
        value["texts"].push_back(cases.factors[j].text(one.setting[j]));
    }
    value["probability"] = json_number(one.probability);
    value["responses"] = responses_of(window, one);
    return value;
}

Json json_of(const Window& window, const FactorCurve& curve) {
    Json value = {{"at", curve.at}, {"probability", Json::array()}, {"responses", Json::array()}};
    for (const auto& one : curve.judged) {
        value["probability"].push_back(json_number(one.probability));
        value["responses"].push_back(responses_of(window, one));
    }
    return value;
}

Json map_of(const ModelCases& cases, const WindowRequest& request, const Window& window, const Admits& admits,
            const Setting& centre, std::size_t a, std::size_t b) {
    const auto across = cells_along(cases.factors[a], points_of_curve),
               up = cells_along(cases.factors[b], points_of_curve);
    std::vector<Setting> settings;
    for (const double y : up)
        for (const double x : across) {
            settings.push_back(centre);
            settings.back()[a] = x;
            settings.back()[b] = y;
        }
    const auto judged = judge_settings(cases, request, window, settings);
    const bool modelled = modelled_objective(request, window);
    Json value = {{"across", a},
                  {"up", b},
                  {"across_edges", cell_edges(cases.factors[a], points_of_curve)},
                  {"up_edges", cell_edges(cases.factors[b], points_of_curve)},
                  {"columns", across.size()},
                  {"rows", up.size()},
                  {"probability", Json::array()},
                  {"objective", modelled ? Json::array() : Json(nullptr)}};
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const bool there = !admits || admits(settings[i]);
        value["probability"].push_back(there ? json_number(judged[i].probability) : Json(nullptr));
        const bool answers = there && judged[i].believed;
        if (modelled) value["objective"].push_back(answers ? json_number(judged[i].objective.mean) : Json(nullptr));
    }
    return value;
}

}  // namespace

Json window_page_data(const ModelCases& cases, const WindowRequest& request, const Window& window,
                      const Admits& admits) {
    const auto& centre = window.best ? *window.best : window.surest.value();
    std::vector<FactorCurve> curves;
    for (std::size_t j = 0; j < cases.factors.size(); ++j)
        curves.push_back(curve_through(cases, request, window, centre.setting, j));
    const bool objective = !request.objective.empty(), modelled = modelled_objective(request, window);
    double whole_range = 0;
    if (modelled) {
        const auto& model = window.models.front();
        const auto means = model.model.means({model.case_features, model.features.names.size()});
        const auto [low, high] = std::ranges::minmax(means);
        whole_range = high - low;
    }
    const auto order = order_of(curves, modelled, whole_range);
    Json value = {{"campaigns", {{{"name", cases.campaign.name}}}},
                  {"campaign", cases.campaign.name},
                  {"scene", cases.campaign.scene},
                  {"where", request.where},
                  {"objective", objective ? Json(request.objective) : Json(nullptr)},
                  {"maximize", request.maximise},
                  {"single_run", request.judged == stats::Judged::single_run},
                  {"risk", request.risk},
                  {"share", window.share_of_box},
                  {"share_error", window.share_error},
                  {"factors", axes_json(cases.factors)},
                  {"meets", window.best.has_value()},
                  {"best", json_of(cases, window, centre)},
                  {"failed", failed_json(cases)},
                  {"failed_near", cases.failed.empty() ? "" : near_text(cases, centre.near)},
                  {"order", order}};
    value["responses"] = Json::array();
    value["models"] = Json::array();
    for (const auto& model : window.models) {
        value["responses"].push_back({{"name", model.observable}, {"unit", model.unit}});
        value["models"].push_back(model_lines(model));
    }
    value["curves"] = Json::array();
    for (const auto& curve : curves) value["curves"].push_back(json_of(window, curve));
    value["map"] =
        order.size() < 2 ? Json(nullptr) : map_of(cases, request, window, admits, centre.setting, order[0], order[1]);
    for (const auto& [name, list] : {std::pair{"front", &window.front}, std::pair{"next", &window.next}}) {
        value[name] = Json::array();
        for (const auto& one : *list) value[name].push_back(json_of(cases, window, one));
    }
    value["against"] = window.against ? Json(window.models[*window.against].observable) : Json(nullptr);
    value["notes"] = window.notes;
    return value;
}

void write_window_page(std::ostream& out, const Json& data, std::string_view database) {
    const auto files = page_files();
    Json all = data;
    all["databases"] = {database};
    const auto text = safe_in_script(all);
    const auto program = enclosed(files.window);
    const auto scripts = script_sources({files.library, program});
    fill(out, files.skeleton,
         {{"scripts", scripts},
          {"style", files.style},
          {"library", files.library},
          {"films", ""},
          {"data", text},
          {"program", program}});
}

}  // namespace grainsweep::report
