#include "sweep/report/window_tables.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/report/model_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

namespace grainsweep::report {

using namespace study;

namespace {

void add_row(store::Table& table, const ModelCases& cases, const Window& window, std::string_view part,
             const Judgement& one) {
    std::vector<store::Table::Cell> row;
    if (!part.empty()) row.emplace_back(std::string(part));
    for (auto& cell : input_cells(cases.factors, one.setting)) row.push_back(std::move(cell));
    row.push_back(to_cell(one.probability));
    const auto near = window.answers->near(one.setting);
    if (!cases.failed.empty())
        row.insert(row.end(), {to_cell(one.answers), static_cast<std::int64_t>(near.cases), std::ssize(near.failed)});
    for (const auto& p : one.predictions)
        for (const double x : {p.mean, p.mean_error, p.scatter}) row.push_back(to_cell(x));
    table.rows.push_back(std::move(row));
}

store::Table empty_table(const ModelCases& cases, const Window& window, bool with_part) {
    store::Table table;
    if (with_part) table.columns.emplace_back("part");
    for (auto& name : cases.factor_names()) table.columns.push_back(std::move(name));
    table.columns.emplace_back("probability");
    if (!cases.failed.empty()) table.columns.insert(table.columns.end(), {"answers", "near_cases", "near_failed"});
    for (const auto& model : window.models)
        for (const char* suffix : {"", "_error", "_scatter"}) table.columns.push_back(model.observable + suffix);
    return table;
}

store::Table settings_table(const ModelCases& cases, const Window& window, std::span<const Judgement> settings) {
    auto table = empty_table(cases, window, false);
    for (const auto& one : settings) add_row(table, cases, window, {}, one);
    return table;
}

Json window_table_json(const ModelCases& cases, const WindowRequest& request, const Window& window,
                       const Judgement& one) {
    const auto estimate = [](const stats::Prediction& p) {
        return Result<results::mean_and_scatter>{
            {"mean", p.mean}, {"mean_error", p.mean_error}, {"scatter", p.scatter}};
    };
    Json observables = Json::object();
    for (std::size_t k = 0; k < window.models.size(); ++k)
        observables.add(window.models[k].observable, estimate(one.predictions[k]));
    Result<results::window_setting> object = {{"inputs", inputs_json(cases.factors, one.setting)}};
    if (!request.objectives.empty()) object.add(estimate(one.objectives[0]));
    const auto near = window.answers->near(one.setting);
    return object.add(Result<results::window_setting>{{"probability", one.probability},
                                                      {"answers", one.answers},
                                                      {"answers_low", one.answers_low},
                                                      {"answers_high", one.answers_high},
                                                      {"near_cases", near.cases},
                                                      {"near_failed", near.failed.size()},
                                                      {"observables", observables}});
}

/// Columns of a computed front: the goals that are no factors, of two objectives with an error each.
store::Table computed_table(const ModelCases& cases, const Window& window) {
    store::Table table;
    table.columns = cases.factor_names();
    table.columns.emplace_back("runs");
    const auto& first = window.goals.front();
    const bool pair = window.goals.size() == 2;
    const std::array goals = {first, *window.against};
    for (const auto& goal : goals) {
        if (!goal.model) continue;
        table.columns.push_back(window.models[*goal.model].observable);
        if (pair) table.columns.push_back(table.columns.back() + "_error");
    }
    for (const auto& one : window.computed_front) {
        auto row = input_cells(cases.factors, one.setting);
        row.emplace_back(one.runs);
        const std::array means = {one.objective, one.against};
        for (std::size_t k = 0; k < goals.size(); ++k) {
            if (!goals[k].model) continue;
            row.push_back(to_cell(pair ? one.judged->objectives[k].mean : means[k]));
            if (pair) row.push_back(to_cell(one.judged->objectives[k].mean_error));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json computed_json(const ModelCases& cases, const Window& window, const FrontSetting& one) {
    Json observables = Json::object(), means = Json::object();
    const std::array goals = {window.goals.front(), *window.against};
    const std::array values = {one.objective, one.against};
    for (std::size_t k = 0; k < goals.size(); ++k) {
        if (!goals[k].model) continue;
        const auto& name = window.models[*goals[k].model].observable;
        observables.add(name, values[k]);
        if (one.judged)
            means.add(name, Result<results::front_mean>{{"mean", one.judged->objectives[k].mean},
                                                        {"mean_error", one.judged->objectives[k].mean_error}});
    }
    Result<results::computed_setting> object = {
        {"inputs", inputs_json(cases.factors, one.setting)}, {"runs", one.runs}, {"observables", observables}};
    if (one.judged) object.add("means", means).add("probability", one.judged->probability);
    return object;
}

Json objective_json(const WindowRequest& request, const Window& window, std::size_t k) {
    using Objective = Result<results::window_objective>;
    const auto& name = request.objectives[k].name;
    auto object = window.goals[k].factor ? Objective{{"factor", name}} : Objective{{"observable", name}};
    object.add("maximize", request.objectives[k].maximise);
    if (window.goals.size() == 2) object.add("reference", window.goals[k].reference);
    return object;
}

Result<results::hypervolume> volume_json(const FrontVolume& volume) {
    return {{"value", volume.value}, {"error", volume.error}, {"further", volume.further}};
}

/// State of the search after each of its campaigns.
store::Table batches_table(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    store::Table table;
    table.columns = {"after", "cases"};
    const bool pair = window.goals.size() == 2, factor = !pair && window.goals[0].factor;
    if (!pair) std::ranges::move(cases.factor_names(), std::back_inserter(table.columns));
    const std::string value = pair ? "hypervolume" : request.objectives[0].name;
    if (!factor) table.columns.insert(table.columns.end(), {value, value + "_error"});
    std::int64_t sum = 0;
    for (const auto& batch : window.batches) {
        sum += batch.cases;
        std::vector<store::Table::Cell> row = {batch.campaign, sum};
        if (pair) {
            row.insert(row.end(), {to_cell(batch.volume->value), to_cell(batch.volume->error)});
        } else if (batch.best) {
            for (auto& cell : input_cells(cases.factors, batch.best->setting)) row.push_back(std::move(cell));
            const auto& objective = batch.best->objectives[0];
            if (!factor) row.insert(row.end(), {to_cell(objective.mean), to_cell(objective.mean_error)});
        }
        row.resize(table.columns.size());
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json batch_json(const ModelCases& cases, const Window& window, const BatchStanding& batch) {
    Result<results::batch> object = {{"campaign", batch.campaign}, {"cases", batch.cases}};
    if (window.goals.size() == 2)
        return object.add("hypervolume", batch.volume->value).add("hypervolume_error", batch.volume->error);
    if (!batch.best) return object.add("best", Json());
    return object.add("best", Result<results::batch_best>{{"inputs", inputs_json(cases.factors, batch.best->setting)},
                                                          {"mean", batch.best->objectives[0].mean},
                                                          {"mean_error", batch.best->objectives[0].mean_error}});
}

std::string_view judged_text(stats::Judged judged) {
    return judged == stats::Judged::mean ? "mean" : "single_run";
}

store::Table window_rows(const ModelCases& cases, const Window& window) {
    auto table = empty_table(cases, window, true);
    if (window.best) add_row(table, cases, window, "best", *window.best);
    if (window.surest) add_row(table, cases, window, "surest", *window.surest);
    for (const auto& one : window.front) add_row(table, cases, window, "front", one);
    for (const auto& one : window.next) add_row(table, cases, window, "next", one);
    return table;
}

void say_settings(Document& shown, std::string heading, const ModelCases& cases, const Window& window,
                  std::span<const Judgement> settings) {
    if (!settings.empty()) shown.say(std::move(heading)).show(settings_table(cases, window, settings)).say();
}

void say_trade_off(Document& shown, const ModelCases& cases, const WindowRequest& request, const Window& window) {
    const auto& first = request.objectives.front().name;
    if (window.volume)
        shown.say(fmt::format("{}, beyond {} {:.6g} and {} {:.6g}\n\n", volume_text(*window.volume), first,
                              window.goals[0].reference, request.objectives[1].name, window.goals[1].reference));
    const auto pair = window.volume ? fmt::format("front of {} and {}", first, request.objectives[1].name)
                                    : fmt::format("trade-off of {} and {}, whether the condition holds or not", first,
                                                  window.models[*window.against->model].observable);
    if (!window.computed_front.empty())
        shown
            .say(pair + (window.volume ? ": computed cases, means by the models"
                                       : ": computed cases, means over the runs of a setting"))
            .show(computed_table(cases, window))
            .say();
    say_settings(shown, pair + ": predictions with a small error", cases, window, window.front);
}

std::span<const Judgement> list_of(const std::optional<Judgement>& one) {
    return one ? std::span(&*one, 1) : std::span<const Judgement>();
}

}  // namespace

std::string volume_text(const FrontVolume& volume) {
    const auto part = volume.value > 0 ? fmt::format(" ({:.2g} %)", 100 * volume.further / volume.value) : "";
    return fmt::format(
        "hypervolume of the computed front {:.6g} +- {:.3g} (95 %), of the best front by the models at most {:.3g}{} "
        "more",
        volume.value, volume.error, volume.further, part);
}

std::string goal_text(const WindowRequest& request) {
    std::string text;
    for (const auto& one : request.objectives)
        text += fmt::format("{}{} {}", text.empty() ? "" : " and ", one.maximise ? "largest" : "smallest", one.name);
    return request.objectives.size() == 2 ? text + ", as a compromise," : text;
}

Result<results::window> window_json(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    const auto json = [&](const Judgement& one) { return window_table_json(cases, request, window, one); };
    Json objective;
    if (!request.objectives.empty()) objective = objective_json(request, window, 0);
    Json objectives = Json::array();
    for (std::size_t k = 0; k < window.goals.size(); ++k) objectives.push_back(objective_json(request, window, k));
    return {{"campaign", cases.campaign.name},
            {"where", request.where},
            {"objective", objective},
            {"objectives", objectives},
            {"risk", request.risk},
            {"judged", judged_text(request.judged)},
            {"share_of_box", window.share_of_box},
            {"share_error", window.share_error},
            {"share_low", window.share_low},
            {"share_high", window.share_high},
            {"share_failed", window.share_failed},
            {"best", window.best ? json(*window.best) : Json()},
            {"surest", window.surest ? json(*window.surest) : Json()},
            {"computed_front",
             Json::list(window.computed_front, [&](const auto& one) { return computed_json(cases, window, one); })},
            {"front", Json::list(window.front, json)},
            {"hypervolume", window.volume ? volume_json(*window.volume) : Json()},
            {"batches", Json::list(window.batches, [&](const auto& one) { return batch_json(cases, window, one); })},
            {"next", Json::list(window.next, json)},
            {"models", Json::list(window.models, model_json)},
            {"notes", window.notes}};
}

Document window_document(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    Document shown{.rows = window_rows(cases, window), .value = window_json(cases, request, window)};
    shown.say(fmt::format("{}: {}", cases.campaign.name, request.where.empty() ? "no condition" : request.where));
    const std::string part = cases.campaign.condition.empty() ? "" : "the part that `where` leaves of ";
    shown.say(fmt::format(
        "holds with probability {:.6g} or more {} in {:.1f} +- {:.1f} % of {}{} ({} settings looked at)\n\n",
        1 - request.risk, request.judged == stats::Judged::mean ? "for the mean" : "for a single run",
        100 * window.share_of_box, 100 * window.share_error, part, share_of(cases.factors), window.searched.size()));
    const auto goal = request.objectives.empty() ? "where the condition is surest" : goal_text(request) + " there";
    say_settings(shown, goal, cases, window, list_of(window.best));
    say_settings(shown, "where the condition is likeliest", cases, window, list_of(window.surest));
    if (window.against) say_trade_off(shown, cases, request, window);
    if (!window.batches.empty())
        shown
            .say(fmt::format("the search so far, by the models of all cases: {}",
                             window.volume ? "hypervolume of the computed front" : "best computed setting"))
            .show(batches_table(cases, request, window))
            .say();
    say_settings(shown, "to run next", cases, window, window.next);
    for (const auto& model : window.models) shown.say(model_lines(model));
    return shown.say_notes(window.notes);
}

}  // namespace grainsweep::report
