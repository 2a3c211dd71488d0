#include "sweep/report/window_tables.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <ostream>

namespace grainsweep::report {

using namespace study;

namespace {

using Json = nlohmann::ordered_json;

void add_row(store::Table& table, const ModelCases& cases, std::string_view part, const Judgement& one) {
    std::vector<store::Table::Cell> row;
    if (!part.empty()) row.emplace_back(std::string(part));
    for (auto& cell : input_cells(cases.factors, one.setting)) row.push_back(std::move(cell));
    row.push_back(to_cell(one.probability));
    if (!cases.failed.empty())
        row.insert(row.end(), {static_cast<std::int64_t>(one.near.cases), std::ssize(one.near.failed)});
    for (const auto& p : one.predictions)
        for (const double x : {p.mean, p.mean_error, p.scatter}) row.push_back(to_cell(x));
    table.rows.push_back(std::move(row));
}

store::Table empty_table(const ModelCases& cases, const Window& window, bool with_part) {
    store::Table table;
    if (with_part) table.columns.emplace_back("part");
    for (auto& name : cases.factor_names()) table.columns.push_back(std::move(name));
    table.columns.emplace_back("probability");
    if (!cases.failed.empty()) table.columns.insert(table.columns.end(), {"near_cases", "near_failed"});
    for (const auto& model : window.models)
        for (const char* suffix : {"", "_error", "_scatter"}) table.columns.push_back(model.observable + suffix);
    return table;
}

store::Table settings_table(const ModelCases& cases, const Window& window, std::span<const Judgement> settings) {
    auto table = empty_table(cases, window, false);
    for (const auto& one : settings) add_row(table, cases, {}, one);
    return table;
}

Json json_of(const ModelCases& cases, const WindowRequest& request, const Window& window, const Judgement& one) {
    Json object = {{"inputs", inputs_json(cases.factors, one.setting)}};
    if (!request.objective.empty()) {
        object["mean"] = json_number(one.objective.mean);
        object["mean_error"] = json_number(one.objective.mean_error);
        object["scatter"] = json_number(one.objective.scatter);
    }
    object["probability"] = json_number(one.probability);
    object["near_cases"] = one.near.cases;
    object["near_failed"] = one.near.failed.size();
    object["observables"] = Json::object();
    for (std::size_t k = 0; k < window.models.size(); ++k)
        object["observables"][window.models[k].observable] = {
            {"mean", json_number(one.predictions[k].mean)},
            {"mean_error", json_number(one.predictions[k].mean_error)},
            {"scatter", json_number(one.predictions[k].scatter)}};
    return object;
}

std::string_view judged_text(stats::Judged judged) {
    return judged == stats::Judged::mean ? "mean" : "single_run";
}

void write_settings(std::ostream& out, std::string_view heading, const ModelCases& cases, const Window& window,
                    std::span<const Judgement> settings) {
    if (settings.empty()) return;
    out << heading << '\n';
    write(out, settings_table(cases, window, settings), Format::text);
    out << '\n';
}

}  // namespace

void write_window(std::ostream& out, const ModelCases& cases, const WindowRequest& request, const Window& window) {
    const std::string where = request.where.empty() ? "no condition" : request.where;
    out << fmt::format("{}: {}\n", cases.campaign.name, where);
    out << fmt::format(
        "holds with probability {:.6g} or more {} in {:.1f} +- {:.1f} % of the box ({} settings looked at)\n\n",
        1 - request.risk, request.judged == stats::Judged::mean ? "for the mean" : "for a single run",
        100 * window.share_of_box, 100 * window.share_error, window.searched.size());
    const auto goal = request.objective.empty()
                          ? std::string("where the condition is surest")
                          : fmt::format("{} {} there", request.maximise ? "largest" : "smallest", request.objective);
    if (window.best) write_settings(out, goal, cases, window, std::span(&*window.best, 1));
    if (window.surest)
        write_settings(out, "where the condition is likeliest", cases, window, std::span(&*window.surest, 1));
    if (window.against)
        write_settings(out,
                       fmt::format("trade-off of {} and {}, whether the condition holds or not", request.objective,
                                   window.models[*window.against].observable),
                       cases, window, window.front);
    write_settings(out, "to run next", cases, window, window.next);
    for (const auto& model : window.models) out << model_lines(model);
    for (const auto& note : window.notes) out << "note: " << note << '\n';
}

Json window_json(const ModelCases& cases, const WindowRequest& request, const Window& window) {
    const auto list = [&](std::span<const Judgement> settings) {
        Json all = Json::array();
        for (const auto& one : settings) all.push_back(json_of(cases, request, window, one));
        return all;
    };
    const auto one_or_null = [&](const std::optional<Judgement>& one) {
        return one ? json_of(cases, request, window, *one) : Json(nullptr);
    };
    Json objective = nullptr;
    if (!request.objective.empty())
        objective = {{window.objective_is_factor ? "factor" : "observable", request.objective},
                     {"maximize", request.maximise}};
    Json models = Json::array();
    for (const auto& model : window.models) models.push_back(model_json(model));
    return {{"campaign", cases.campaign.name},
            {"where", request.where},
            {"objective", objective},
            {"risk", request.risk},
            {"judged", judged_text(request.judged)},
            {"share_of_box", window.share_of_box},
            {"share_error", window.share_error},
            {"share_failed", window.share_failed},
            {"best", one_or_null(window.best)},
            {"surest", one_or_null(window.surest)},
            {"front", list(window.front)},
            {"next", list(window.next)},
            {"models", models},
            {"notes", window.notes}};
}

store::Table window_rows(const ModelCases& cases, const Window& window) {
    auto table = empty_table(cases, window, true);
    if (window.best) add_row(table, cases, "best", *window.best);
    if (window.surest) add_row(table, cases, "surest", *window.surest);
    for (const auto& one : window.front) add_row(table, cases, "front", one);
    for (const auto& one : window.next) add_row(table, cases, "next", one);
    return table;
}

}  // namespace grainsweep::report
