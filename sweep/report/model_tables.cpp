#include "sweep/report/model_tables.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/cases_near.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::report {

using Json = nlohmann::ordered_json;

std::string model_lines(const ObservableModel& model) {
    const auto& quality = model.model.quality();
    std::string text = fmt::format(
        "model of {}: {} cases, leave-one-out error {:.3f} of the standard deviation; {:.0f} % of the cases lie in "
        "their 50 % interval, {:.0f} % in their 95 % interval; {:.1f} % of the variance is scatter of single runs\n"
        "features: {}{}\n",
        model.observable, quality.rests_on, quality.leave_one_out_error, 100 * quality.coverage_50,
        100 * quality.coverage_95, 100 * quality.noise_share, campaign::listed(model.features.names),
        quality.learned_map ? ", and a linear map of them that is learned" : "");
    for (const auto& note : model.notes) text += fmt::format("note: {}\n", note);
    return text;
}

Json model_json(const ObservableModel& model) {
    const auto& quality = model.model.quality();
    return {{"observable", model.observable},
            {"cases", quality.cases},
            {"rests_on", quality.rests_on},
            {"undefined", model.undefined},
            {"leave_one_out_error", json_number(quality.leave_one_out_error)},
            {"coverage_50", json_number(quality.coverage_50)},
            {"coverage_95", json_number(quality.coverage_95)},
            {"noise_share", json_number(quality.noise_share)},
            {"features", model.features.names},
            {"learned_map", quality.learned_map},
            {"notes", model.notes}};
}

std::vector<store::Table::Cell> input_cells(std::span<const ModelFactor> factors, const Setting& setting) {
    std::vector<store::Table::Cell> cells;
    for (std::size_t j = 0; j < factors.size(); ++j) cells.push_back(to_cell(factors[j].value(setting[j])));
    return cells;
}

Json inputs_json(std::span<const ModelFactor> factors, const Setting& setting) {
    Json inputs = Json::object();
    const auto cells = input_cells(factors, setting);
    for (std::size_t j = 0; j < factors.size(); ++j) inputs[factors[j].name] = to_json(cells[j]);
    return inputs;
}

namespace {

/// A prediction rests on numbers: of a feature that has none there is no sense in one.
void refuse_undefined(const ModelCases& cases, const ObservableModel& model, std::span<const Setting> settings) {
    for (const auto& setting : settings) {
        const auto row = model.features.of(setting);
        const auto bad = std::ranges::find_if_not(row, [](double x) { return std::isfinite(x); });
        if (bad != row.end())
            throw campaign::wrong_question(
                "", setting_text(cases.factors, setting),
                fmt::format("the feature '{}' of the model has no number there",
                            model.features.names[static_cast<std::size_t>(bad - row.begin())]));
    }
}

}  // namespace

Predicted predict(const ModelCases& cases, const ObservableModel& model, std::vector<Setting> settings,
                  bool extrapolate) {
    refuse_undefined(cases, model, settings);
    Predicted predicted{std::move(settings), {}, {}, {}};
    predicted.predictions = model.predict(predicted.settings);
    predicted.defined = model.defined(predicted.settings);
    const CasesNear near(cases);
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        predicted.near.push_back(near.at(predicted.settings[i]));
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        if (!predicted.near[i].answers && !extrapolate)
            predicted.predictions[i] = {.mean = none, .mean_error = none, .scatter = none};
    }
    return predicted;
}

store::Table predictions_table(const ModelCases& cases, const ObservableModel& model, const Predicted& predicted) {
    store::Table table;
    table.columns = cases.factor_names();
    for (const char* name : {"mean", "mean_error", "scatter", "inside"}) table.columns.emplace_back(name);
    if (model.undefined > 0) table.columns.emplace_back("defined");
    if (!cases.failed.empty()) table.columns.insert(table.columns.end(), {"answers_near", "near_cases", "near_failed"});
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        auto row = input_cells(cases.factors, predicted.settings[i]);
        const auto& p = predicted.predictions[i];
        for (const double x : {p.mean, p.mean_error, p.scatter}) row.push_back(to_cell(x));
        row.emplace_back(std::int64_t{outside_text(cases.factors, predicted.settings[i]).empty()});
        if (model.undefined > 0) row.push_back(to_cell(predicted.defined[i]));
        const auto& near = predicted.near[i];
        if (!cases.failed.empty())
            row.insert(row.end(),
                       {std::int64_t{near.answers}, static_cast<std::int64_t>(near.cases), std::ssize(near.failed)});
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::string failures_near(const ModelCases& cases, const Predicted& predicted) {
    const auto without = std::ranges::find_if_not(predicted.near, &Near::answers);
    if (without == predicted.near.end()) return {};
    const auto place = static_cast<std::size_t>(without - predicted.near.begin());
    const auto n = std::ranges::count_if(predicted.near, [](const Near& near) { return !near.answers; });
    std::string text = fmt::format("no case near {} has an answer: {}\n",
                                   setting_text(cases.factors, predicted.settings[place]), near_text(cases, *without));
    if (n > 1) text += fmt::format("{} of {} settings have no answered case near\n", n, predicted.near.size());
    return text;
}

Json predictions_json(const ModelCases& cases, const ObservableModel& model, const Predicted& predicted) {
    Json points = Json::array();
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        const auto& p = predicted.predictions[i];
        points.push_back({{"inputs", inputs_json(cases.factors, predicted.settings[i])},
                          {"mean", json_number(p.mean)},
                          {"mean_error", json_number(p.mean_error)},
                          {"scatter", json_number(p.scatter)},
                          {"inside", outside_text(cases.factors, predicted.settings[i]).empty()},
                          {"defined", json_number(predicted.defined[i])},
                          {"answers_near", predicted.near[i].answers},
                          {"near_cases", predicted.near[i].cases},
                          {"near_failed", predicted.near[i].failed.size()}});
    }
    return {{"campaign", cases.campaign.name},
            {"observable", model.observable},
            {"points", points},
            {"model", model_json(model)}};
}

}  // namespace grainsweep::report
