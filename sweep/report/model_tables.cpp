#include "sweep/report/model_tables.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {

using namespace study;

namespace {

std::string lines_of(const ObservableModel& named, const stats::ResponseModel& model) {
    const auto& quality = model.quality();
    return fmt::format(
        "model of {}: {} cases, leave-one-out error {:.3f} of the standard deviation; {:.0f} % of the cases lie in "
        "their 50 % interval, {:.0f} % in their 95 % interval; {:.1f} % of the variance is scatter of single runs\n"
        "features: {}{}\n",
        named.observable, quality.rests_on, quality.leave_one_out_error, 100 * quality.coverage_50,
        100 * quality.coverage_95, 100 * quality.noise_share, campaign::listed(named.features.names),
        quality.learned_map ? ", and a linear map of them that is learned" : "");
}

std::string lines_of(const ObservableModel& named, const stats::ProbabilityModel& model) {
    const auto& quality = model.quality();
    return fmt::format(
        "model of {}: the probability of a 1, from {} cases, {} of them 1; the mean square of left-out cases less "
        "their "
        "probability is {:.3f}, and {:.3f} with the share of ones alone\nfeatures: {}\n",
        named.observable, quality.rests_on, quality.ones, quality.brier, quality.brier_of_share,
        campaign::listed(named.features.names));
}

Result<results::model> quality_json(const stats::ResponseModel& model) {
    const auto& quality = model.quality();
    return {{"leave_one_out_error", quality.leave_one_out_error},
            {"coverage_50", quality.coverage_50},
            {"coverage_95", quality.coverage_95},
            {"noise_share", quality.noise_share},
            {"learned_map", quality.learned_map}};
}

Result<results::model> quality_json(const stats::ProbabilityModel& model) {
    const auto& quality = model.quality();
    return {{"ones", quality.ones}, {"brier", quality.brier}, {"brier_of_share", quality.brier_of_share}};
}

}  // namespace

std::string model_lines(const ObservableModel& model) {
    std::string text = std::visit([&](const auto& one) { return lines_of(model, one); }, model.model);
    for (const auto& note : model.notes) text += fmt::format("note: {}\n", note);
    return text;
}

Result<results::model> model_json(const ObservableModel& model) {
    const auto rests_on = std::visit([](const auto& one) { return one.quality().rests_on; }, model.model);
    Result<results::model> object = {{"observable", model.observable},
                                     {"kind", model.is_probability() ? "probability" : "response"},
                                     {"cases", model.cases()},
                                     {"rests_on", rests_on},
                                     {"undefined", model.undefined},
                                     {"features", model.features.names},
                                     {"notes", model.notes}};
    return object.add(std::visit([](const auto& one) { return quality_json(one); }, model.model));
}

std::vector<store::Table::Cell> input_cells(std::span<const ModelFactor> factors, const Setting& setting) {
    std::vector<store::Table::Cell> cells;
    for (std::size_t j = 0; j < factors.size(); ++j)
        cells.push_back(std::isnan(setting[j]) ? store::Table::Cell{} : to_cell(factors[j].value_of(setting[j])));
    return cells;
}

Json inputs_json(std::span<const ModelFactor> factors, const Setting& setting) {
    Json inputs = Json::object();
    const auto cells = input_cells(factors, setting);
    for (std::size_t j = 0; j < factors.size(); ++j) inputs.add(factors[j].name, to_json(cells[j]));
    return inputs;
}

store::Table predictions_table(const ModelCases& cases, const ObservableModel& model, const Predicted& predicted) {
    store::Table table;
    table.columns = cases.factor_names();
    for (const char* name : {"mean", "mean_error", "scatter", "inside"}) table.columns.emplace_back(name);
    if (model.is_probability()) table.columns.insert(table.columns.end(), {"mean_low", "mean_high"});
    if (model.undefined > 0) table.columns.emplace_back("defined");
    if (!cases.failed.empty())
        table.columns.insert(table.columns.end(),
                             {"answers", "answers_low", "answers_high", "near_cases", "near_failed"});
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        auto row = input_cells(cases.factors, predicted.settings[i]);
        const auto& p = predicted.predictions[i];
        for (const double x : {p.mean, p.mean_error, p.scatter}) row.push_back(to_cell(x));
        row.emplace_back(std::int64_t{outside_text(cases.factors, predicted.settings[i]).empty()});
        if (model.is_probability()) row.insert(row.end(), {to_cell(p.mean_low()), to_cell(p.mean_high())});
        if (model.undefined > 0) row.push_back(to_cell(predicted.defined[i]));
        const auto& near = predicted.near[i];
        if (!cases.failed.empty())
            row.insert(row.end(), {to_cell(predicted.answers[i]), to_cell(predicted.answers_low[i]),
                                   to_cell(predicted.answers_high[i]), static_cast<std::int64_t>(near.cases),
                                   std::ssize(near.failed)});
        table.rows.push_back(std::move(row));
    }
    return table;
}

Result<results::predict> predictions_json(const ModelCases& cases, const ObservableModel& model,
                                          const Predicted& predicted) {
    Json points = Json::array();
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        const auto& p = predicted.predictions[i];
        points.push_back(
            Result<results::prediction>{{"inputs", inputs_json(cases.factors, predicted.settings[i])},
                                        {"mean", p.mean},
                                        {"mean_error", p.mean_error},
                                        {"mean_low", p.mean_low()},
                                        {"mean_high", p.mean_high()},
                                        {"scatter", p.scatter},
                                        {"inside", outside_text(cases.factors, predicted.settings[i]).empty()},
                                        {"defined", predicted.defined[i]},
                                        {"answers", predicted.answers[i]},
                                        {"answers_low", predicted.answers_low[i]},
                                        {"answers_high", predicted.answers_high[i]},
                                        {"near_cases", predicted.near[i].cases},
                                        {"near_failed", predicted.near[i].failed.size()}});
    }
    return {{"campaign", cases.campaign.name},
            {"observable", model.observable},
            {"points", points},
            {"model", model_json(model)}};
}

namespace {

/// Returns the table with the columns of the factors, which may be many, behind the others.
store::Table answer_first(store::Table table, std::size_t factors) {
    const auto turn = [&](auto& cells) {
        std::ranges::rotate(cells, cells.begin() + static_cast<std::ptrdiff_t>(factors));
    };
    turn(table.columns);
    for (auto& row : table.rows) turn(row);
    return table;
}

}  // namespace

Document predictions_document(const ModelCases& cases, const ObservableModel& model, const Predicted& predicted) {
    Document shown{.rows = predictions_table(cases, model, predicted),
                   .value = predictions_json(cases, model, predicted)};
    shown.say(fmt::format("{}: {}", cases.campaign.name, with_unit(model.observable, model.unit))).say();
    shown.show(answer_first(shown.rows, cases.factors.size())).say();
    if (const auto failures = failures_near(cases, predicted); !failures.empty()) shown.say(failures).say();
    return shown.say(model_lines(model));
}

Json axes_json(std::span<const ModelFactor> factors) {
    return Json::list(factors, [](const ModelFactor& factor) {
        Json levels = factor.words;
        for (const double x : factor.numbers) levels.push_back(factor.text(x));
        return Json{{"name", factor.name}, {"unit", factor.unit},   {"levels", levels},   {"numbers", factor.numbers},
                    {"low", factor.low()}, {"high", factor.high()}, {"log", factor.log()}};
    });
}

}  // namespace grainsweep::report
