#include "sweep/report/model_tables.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::report {

using namespace study;

using Json = nlohmann::ordered_json;

constexpr std::size_t most_drawn = 2000;

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

nlohmann::ordered_json axes_json(std::span<const ModelFactor> factors) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& factor : factors) {
        auto levels = nlohmann::ordered_json::array();
        for (const auto& word : factor.words) levels.push_back(word);
        for (const double x : factor.numbers) levels.push_back(factor.text(x));
        list.push_back({{"name", factor.name},
                        {"unit", factor.unit},
                        {"levels", levels},
                        {"numbers", factor.numbers},
                        {"low", factor.low},
                        {"high", factor.high},
                        {"log", factor.log}});
    }
    return list;
}

nlohmann::ordered_json failed_json(const ModelCases& cases) {
    std::vector<std::size_t> all(cases.failed.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    auto list = nlohmann::ordered_json::array();
    for (const auto i : study::random_rows(std::move(all), most_drawn))
        list.push_back(
            {{"setting", cases.failed[i].setting}, {"outcome", campaign::to_string(cases.failed[i].outcome)}});
    return list;
}

}  // namespace grainsweep::report
