#include "sweep/report/convergence_tables.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/report/table.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grainsweep::report {

using namespace study;

namespace {

using Cell = store::Table::Cell;
using Json = nlohmann::ordered_json;
constexpr std::size_t most_shown_checks = 20;

bool is_gate(const History& history, stats::Statistic statistic) {
    return std::ranges::find(history.settings.gates, statistic) != history.settings.gates.end();
}

std::string percent(double share) {
    if (!std::isfinite(share)) return "-";
    return share < 1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

/// The check the verdict is about: complete, else of all points.
const stats::Checkpoint& judged_check(const History& history) {
    return history.checks.empty() ? history.all : history.checks.back();
}

std::string gate_text(const History& history, stats::Statistic statistic) {
    if (!history.has_rule || !is_gate(history, statistic) || history.checks.empty()) return "";
    return judged_check(history).of(statistic).measure < history.settings.tolerance ? "within" : "not within";
}

Cell needed_cell(const History& history) {
    const auto& check = judged_check(history);
    return check.points_needed ? Cell{*check.points_needed} : Cell{};
}

store::Table no_checks() {
    return {{"campaign", "observable", "points", "mean", "sd", "skewness", "g1", "kurtosis", "mean_error", "sd_error",
             "skewness_error", "g1_error", "kurtosis_error", "zero_share", "excluded", "converged", "provisional"},
            {}};
}

struct CheckFlags {
    bool converged = false, provisional = false;
};

void add_check(store::Table& table, const Responses& responses, const ResponseColumn& response,
               const stats::Checkpoint& check, CheckFlags flags) {
    std::vector<Cell> row = {responses.campaign.name, response.name, check.points};
    for (const auto statistic : stats::statistics) row.push_back(to_cell(check.of(statistic).value));
    for (const auto statistic : stats::statistics) row.push_back(to_cell(check.of(statistic).error));
    row.push_back(to_cell(check.zero_share));
    row.emplace_back(check.excluded);
    row.emplace_back(std::int64_t{flags.converged});
    row.emplace_back(std::int64_t{flags.provisional});
    table.rows.push_back(std::move(row));
}

Json provisional_of(const History& history) {
    if (!history.provisional) return nullptr;
    const auto& known = *history.provisional;
    Json value = {{"points", known.points}, {"values", known.count}, {"excluded", known.excluded}};
    for (const auto statistic : stats::statistics) {
        value["statistics"][std::string(stats::to_string(statistic))] = {
            {"value", json_number(known.of(statistic).value)}, {"error", json_number(known.of(statistic).error)}};
    }
    return value;
}

Json with_error_json(double value, double error) {
    return {{"value", json_number(value)}, {"error", json_number(error)}};
}

/// An estimate with a model, marked where it is withdrawn.
std::string shown_estimate(const stats::AssistedStatistic& statistic, const stats::AssistedEstimate& estimate) {
    return (statistic.withdrawn ? "withdrawn: " : "") + with_error(estimate.value, estimate.half_width);
}

std::string key(stats::Statistic statistic) {
    return std::string(stats::to_string(statistic));
}

/// Of which population both estimates are, where some cases have no value.
std::string population_line(const Estimators& estimators) {
    return fmt::format(
        "{} of {} cases have no value: the estimates with a model are of the whole box, extrapolated into the settings "
        "that failed; the plain ones are of the cases that answer",
        estimators.without_value, estimators.without_value + estimators.assisted->cases);
}

}  // namespace

store::Table statistics_table(const History& history) {
    store::Table table{{"statistic", "value", "error", "measure", "gate"}, {}};
    for (const auto statistic : stats::statistics) {
        const auto& all = history.all.of(statistic);
        const double measure = judged_check(history).of(statistic).measure;
        table.rows.push_back({std::string(to_string(statistic)), to_cell(all.value), to_cell(all.error),
                              percent(measure), gate_text(history, statistic)});
    }
    return table;
}

store::Table provisional_table(const History& history) {
    store::Table table{{"statistic", "value", "error"}, {}};
    if (!history.provisional) return table;
    for (const auto statistic : stats::statistics) {
        const auto& known = history.provisional->of(statistic);
        table.rows.push_back({std::string(to_string(statistic)), to_cell(known.value), to_cell(known.error)});
    }
    return table;
}

store::Table checks_table(const History& history) {
    store::Table table{{"points", "mean", "sd", "skewness", "g1", "kurtosis", "excluded", "zeros", ""}, {}};
    const auto add = [&](const stats::Checkpoint& check, const std::string& remark) {
        std::vector<Cell> row = {check.points};
        for (const auto statistic : stats::statistics)
            row.emplace_back(with_error(check.of(statistic).value, check.of(statistic).error));
        row.emplace_back(check.excluded);
        row.emplace_back(percent(check.zero_share));
        row.emplace_back(remark);
        table.rows.push_back(std::move(row));
    };
    for (const auto* check : checks_to_show(history, most_shown_checks))
        add(*check, check == &history.all ? "not a check" : check->converged ? "converged" : "");
    return table;
}

store::Table checks_rows(const Responses& responses, const ResponseColumn& response, const History& history) {
    store::Table table = no_checks();
    for (const auto& check : history.checks)
        add_check(table, responses, response, check, {.converged = check.converged});
    if (history.all.points > 0 && (history.checks.empty() || history.checks.back().points != history.all.points))
        add_check(table, responses, response, history.all, {});
    return table;
}

store::Table provisional_rows(const Responses& responses, const ResponseColumn& response, const History& history) {
    store::Table table = no_checks();
    if (history.provisional) add_check(table, responses, response, *history.provisional, {.provisional = true});
    return table;
}

store::Table lattice_table(std::span<const LatticeStep> steps) {
    store::Table table{{"campaign", "points", "values"}, {}};
    for (const auto statistic : stats::statistics) {
        table.columns.emplace_back(to_string(statistic));
        table.columns.push_back(fmt::format("{}_change", to_string(statistic)));
    }
    for (const auto& step : steps) {
        std::vector<Cell> row = {step.campaign, step.points, step.summary.count};
        for (std::size_t s = 0; s < stats::statistics.size(); ++s) {
            row.push_back(to_cell(step.summary.of(stats::statistics[s])));
            row.push_back(to_cell(step.changes[s]));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

store::Table lattice_lines(std::span<const LatticeStep> steps) {
    store::Table table{{"lattice", "points", "values"}, {}};
    for (const auto statistic : stats::statistics)
        table.columns.push_back(fmt::format("{} (moved)", to_string(statistic)));
    for (const auto& step : steps) {
        std::vector<Cell> row = {step.campaign, step.points, step.summary.count};
        for (std::size_t s = 0; s < stats::statistics.size(); ++s) {
            const auto value = with_error(step.summary.of(stats::statistics[s]), std::nan(""));
            row.emplace_back(std::isfinite(step.changes[s]) ? fmt::format("{} ({})", value, percent(step.changes[s]))
                                                            : value);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json to_json(const Responses& responses, const ResponseColumn& response, const History& history,
             std::span<const LatticeStep> lattices) {
    Json value = {{"campaign", responses.campaign.name},
                  {"observable", response.name},
                  {"unit", response.unit},
                  {"design", responses.campaign.design},
                  {"points", history.all.points},
                  {"values", history.all.count},
                  {"excluded", history.all.excluded},
                  {"zero_share", json_number(history.all.zero_share)},
                  {"candidates", responses.candidates},
                  {"dropped", responses.dropped()},
                  {"asked", responses.rows()},
                  {"finished", responses.finished()}};
    value["provisional"] = provisional_of(history);
    value["rule"] = history.has_rule ? Json(stats::to_string(history.settings.rule)) : Json(nullptr);
    value["tolerance"] = history.has_rule ? Json(history.settings.tolerance) : Json(nullptr);
    value["gates"] = Json::array();
    if (history.has_rule)
        for (const auto gate : history.settings.gates) value["gates"].push_back(stats::to_string(gate));
    for (const auto statistic : stats::statistics) {
        const auto& all = history.all.of(statistic);
        value["statistics"][std::string(stats::to_string(statistic))] = {
            {"value", json_number(all.value)},
            {"error", json_number(all.error)},
            {"measure", json_number(judged_check(history).of(statistic).measure)}};
    }
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    const bool judged = history.has_rule && converged != history.checks.end();
    value["converged"] = judged;
    value["converged_at"] = judged ? Json(converged->points) : Json(nullptr);
    const auto& held_back = judged_check(history).held_back;
    value["held_back_by"] = !judged && held_back ? Json(stats::to_string(*held_back)) : Json(nullptr);
    value["points_needed"] = to_json(needed_cell(history));
    value["verdict"] = history.verdict;
    value["notes"] = history.warnings;
    value["checks"] = to_json(checks_rows(responses, response, history));
    if (!lattices.empty()) value["lattices"] = to_json(lattice_table(lattices));
    return value;
}

store::Table estimators_table(const Estimators& estimators) {
    store::Table table{{"statistic", "plain", "with a model"}, {}};
    const bool scatter_known = !estimators.scatter_from.empty();
    if (scatter_known) table.columns.emplace_back("without scatter");
    if (!estimators.assisted) return table;
    for (const auto statistic : stats::assisted_statistics) {
        const auto& one = estimators.assisted->of(statistic);
        std::vector<store::Table::Cell> row = {key(statistic), with_error(one.plain.value, one.plain.half_width),
                                               shown_estimate(one, one.assisted)};
        if (scatter_known) row.emplace_back(shown_estimate(one, one.without_scatter));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::vector<std::string> estimator_lines(const Estimators& estimators) {
    if (!estimators.assisted) return {estimators.refused};
    const auto& assisted = *estimators.assisted;
    std::vector<std::string> lines;
    lines.push_back(fmt::format(
        "the model of {} cases predicts left-out sequences with an error of {:.3f} standard deviations; features: {}",
        assisted.cases, assisted.model_error, campaign::listed(estimators.features)));
    if (!estimators.scatter_from.empty())
        lines.push_back(fmt::format("scatter of single runs, by {}: {:.2g} % of the variance", estimators.scatter_from,
                                    100 * assisted.budget[0].scatter));
    if (estimators.without_value > 0) lines.push_back(population_line(estimators));
    if (!assisted.remark.empty()) lines.push_back(assisted.remark);
    return lines;
}

Json estimators_json(const History& history, const Estimators& estimators) {
    Json plain = Json::object();
    for (const auto statistic : stats::statistics)
        plain[key(statistic)] = with_error_json(history.all.of(statistic).value, history.all.of(statistic).error);
    Json value = {{"plain", plain}, {"model_assisted", nullptr}, {"without_scatter", nullptr}};
    value["model_error"] = nullptr;
    value["features"] = estimators.features;
    value["scatter_from"] = nullptr;
    value["scatter_share"] = nullptr;
    value["note"] = estimators.refused;
    value["population"] = "";
    if (!estimators.assisted) return value;
    const auto& assisted = *estimators.assisted;
    const bool scatter_known = !estimators.scatter_from.empty();
    for (const auto statistic : stats::assisted_statistics) {
        const auto& one = assisted.of(statistic);
        value["model_assisted"][key(statistic)] = with_error_json(one.assisted.value, one.assisted.half_width);
        value["model_assisted"][key(statistic)]["taken"] = one.takes_assisted;
        value["model_assisted"][key(statistic)]["withdrawn"] = one.withdrawn;
        if (!scatter_known) continue;
        value["without_scatter"][key(statistic)] =
            with_error_json(one.without_scatter.value, one.without_scatter.half_width);
        value["without_scatter"][key(statistic)]["withdrawn"] = one.withdrawn;
    }
    value["model_error"] = json_number(assisted.model_error);
    value["note"] = assisted.remark;
    if (estimators.without_value > 0) value["population"] = population_line(estimators);
    if (!scatter_known) return value;
    value["scatter_from"] = estimators.scatter_from;
    const auto share = [&](std::size_t p) {
        const auto& budget = assisted.budget[p];
        return json_number(budget.scatter / (budget.response + budget.scatter));
    };
    value["scatter_share"] = {{"variance", share(0)}, {"third_moment", share(1)}, {"fourth_moment", share(2)}};
    return value;
}

}  // namespace grainsweep::report
