#include "sweep/report/window_tables.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/model_tables.hpp"

#include <fmt/format.h>
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
        return Json{{"mean", p.mean}, {"mean_error", p.mean_error}, {"scatter", p.scatter}};
    };
    Json observables = Json::object();
    for (std::size_t k = 0; k < window.models.size(); ++k)
        observables.add(window.models[k].observable, estimate(one.predictions[k]));
    Json object = {{"inputs", inputs_json(cases.factors, one.setting)}};
    if (!request.objective.empty()) object.add(estimate(one.objective));
    const auto near = window.answers->near(one.setting);
    return object.add({{"probability", one.probability},
                       {"answers", one.answers},
                       {"answers_low", one.answers_low},
                       {"answers_high", one.answers_high},
                       {"near_cases", near.cases},
                       {"near_failed", near.failed.size()},
                       {"observables", observables}});
}

store::Table computed_table(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    store::Table table;
    table.columns = cases.factor_names();
    table.columns.emplace_back("runs");
    if (!window.objective_is_factor) table.columns.push_back(request.objective);
    table.columns.push_back(window.models[*window.against].observable);
    for (const auto& one : window.computed_front) {
        auto row = input_cells(cases.factors, one.setting);
        row.emplace_back(one.runs);
        if (!window.objective_is_factor) row.push_back(to_cell(one.objective));
        row.push_back(to_cell(one.against));
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json computed_json(const ModelCases& cases, const WindowRequest& request, const Window& window,
                   const study::ComputedSetting& one) {
    Json observables = Json::object();
    if (!window.objective_is_factor) observables.add(request.objective, one.objective);
    observables.add(window.models[*window.against].observable, one.against);
    return {{"inputs", inputs_json(cases.factors, one.setting)}, {"runs", one.runs}, {"observables", observables}};
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

std::span<const Judgement> list_of(const std::optional<Judgement>& one) {
    return one ? std::span(&*one, 1) : std::span<const Judgement>();
}

}  // namespace

Json window_json(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    const auto json = [&](const Judgement& one) { return window_table_json(cases, request, window, one); };
    Json objective;
    if (!request.objective.empty())
        objective = {{window.objective_is_factor ? "factor" : "observable", request.objective},
                     {"maximize", request.maximise}};
    return {{"campaign", cases.campaign.name},
            {"where", request.where},
            {"objective", objective},
            {"risk", request.risk},
            {"judged", judged_text(request.judged)},
            {"share_of_box", window.share_of_box},
            {"share_error", window.share_error},
            {"share_low", window.share_low},
            {"share_high", window.share_high},
            {"share_failed", window.share_failed},
            {"best", window.best ? json(*window.best) : Json()},
            {"surest", window.surest ? json(*window.surest) : Json()},
            {"computed_front", Json::list(window.computed_front,
                                          [&](const auto& one) { return computed_json(cases, request, window, one); })},
            {"front", Json::list(window.front, json)},
            {"next", Json::list(window.next, json)},
            {"models", Json::list(window.models, model_json)},
            {"notes", window.notes}};
}

Document window_document(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    Document shown{.rows = window_rows(cases, window), .value = window_json(cases, request, window)};
    shown.say(fmt::format("{}: {}", cases.campaign.name, request.where.empty() ? "no condition" : request.where));
    shown.say(fmt::format(
        "holds with probability {:.6g} or more {} in {:.1f} +- {:.1f} % of {} ({} settings looked at)\n\n",
        1 - request.risk, request.judged == stats::Judged::mean ? "for the mean" : "for a single run",
        100 * window.share_of_box, 100 * window.share_error, share_of(cases.factors), window.searched.size()));
    const auto goal = request.objective.empty()
                          ? std::string("where the condition is surest")
                          : fmt::format("{} {} there", request.maximise ? "largest" : "smallest", request.objective);
    say_settings(shown, goal, cases, window, list_of(window.best));
    say_settings(shown, "where the condition is likeliest", cases, window, list_of(window.surest));
    if (window.against) {
        const auto pair = fmt::format("{} and {}, whether the condition holds or not", request.objective,
                                      window.models[*window.against].observable);
        if (!window.computed_front.empty())
            shown.say("trade-off of " + pair + ": computed cases, means over the runs of a setting")
                .show(computed_table(cases, request, window))
                .say();
        say_settings(shown, "trade-off of " + pair + ": predictions with a small error", cases, window, window.front);
    }
    say_settings(shown, "to run next", cases, window, window.next);
    for (const auto& model : window.models) shown.say(model_lines(model));
    return shown.say_notes(window.notes);
}

}  // namespace grainsweep::report
