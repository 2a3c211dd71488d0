#include "sweep/report/study_tables.hpp"

#include "sweep/report/summary.hpp"
#include "sweep/report/table.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grainsweep::report {
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

std::string_view method_name(Influence::Method method) {
    switch (method) {
        case Influence::Method::given_data:
            return "given_data";
        case Influence::Method::saltelli:
            return "saltelli";
        case Influence::Method::morris:
            return "morris";
    }
    return "";
}

/// What factors are ordered by: the most telling figure the method gives.
double weight(const FactorInfluence& factor) {
    const double value = factor.effects                      ? factor.effects->mu_star
                         : std::isfinite(factor.total.value) ? factor.total.value
                                                             : factor.first.value;
    return std::isfinite(value) ? value : -1;
}

Cell needed_cell(const History& history) {
    const auto& check = judged_check(history);
    return check.points_needed ? Cell{*check.points_needed} : Cell{};
}

Cell trend_cell(const FactorInfluence& factor) {
    return factor.trend == Trend::unknown ? Cell{} : Cell{std::string(to_string(factor.trend))};
}

Json json_of(const stats::SensitivityIndex& index) {
    return {{"value", json_number(index.value)}, {"error", json_number(index.half_width)}};
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

store::Table influence_table(const Influence& influence) {
    std::vector<const FactorInfluence*> order;
    for (const auto& factor : influence.factors) order.push_back(&factor);
    std::ranges::stable_sort(order, std::ranges::greater{}, [](const auto* factor) { return weight(*factor); });
    store::Table table{{"factor"}, {}};
    const bool morris = influence.method == Influence::Method::morris;
    if (morris) {
        table.columns.insert(table.columns.end(), {"trend", "mu*", "mu", "sigma", "effects"});
    } else {
        table.columns.emplace_back("first order");
        if (influence.method == Influence::Method::saltelli) table.columns.emplace_back("total");
        table.columns.insert(table.columns.end(), {"trend", "rank correlation"});
    }
    for (const auto* factor : order) {
        std::vector<Cell> row = {factor->factor};
        if (morris) row.push_back(trend_cell(*factor));
        if (morris && factor->effects) {
            row.emplace_back(with_error(factor->effects->mu_star, factor->effects->mu_star_half_width));
            row.push_back(to_cell(factor->effects->mu));
            row.push_back(to_cell(factor->effects->sigma));
            row.emplace_back(factor->effects->count);
        } else if (!morris) {
            row.emplace_back(index_text(factor->first));
            if (influence.method == Influence::Method::saltelli) row.emplace_back(index_text(factor->total));
            row.push_back(trend_cell(*factor));
            row.emplace_back(with_error(factor->rank_correlation.value, factor->rank_correlation.half_width));
        }
        row.resize(table.columns.size());
        table.rows.push_back(std::move(row));
    }
    return table;
}

store::Table influence_rows(const Responses& responses, const ResponseColumn& response, const Influence& influence) {
    store::Table table{{"campaign", "observable", "method", "factor", "first", "first_error", "first_saltelli",
                        "first_saltelli_error", "total", "total_error", "mu", "mu_star", "mu_star_error", "sigma",
                        "used", "excluded", "trend", "rank_correlation", "rank_correlation_error"},
                       {}};
    for (const auto& factor : influence.factors) {
        std::vector<Cell> row = {responses.campaign.name, response.name, std::string(method_name(influence.method)),
                                 factor.factor};
        for (const auto& index : {factor.first, factor.first_saltelli, factor.total}) {
            row.push_back(to_cell(index.value));
            row.push_back(to_cell(index.half_width));
        }
        const auto effects = factor.effects.value_or(stats::ElementaryEffects{});
        for (const double x : {effects.mu, effects.mu_star, effects.mu_star_half_width, effects.sigma})
            row.push_back(to_cell(x));
        row.emplace_back(influence.used);
        row.emplace_back(influence.excluded);
        row.push_back(trend_cell(factor));
        row.push_back(to_cell(factor.rank_correlation.value));
        row.push_back(to_cell(factor.rank_correlation.half_width));
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json to_json(const Responses& responses, const ResponseColumn& response, const Influence& influence) {
    Json value = {{"campaign", responses.campaign.name},
                  {"observable", response.name},
                  {"method", method_name(influence.method)},
                  {"used", influence.used},
                  {"excluded", influence.excluded}};
    value["factors"] = Json::array();
    for (const auto& factor : influence.factors) {
        Json one = {{"name", factor.factor}};
        const auto put = [&](const char* name, const stats::SensitivityIndex& index) { one[name] = json_of(index); };
        if (influence.method != Influence::Method::morris) {
            one["bins"] = factor.bins;
            put("first", factor.first);
        }
        if (influence.method == Influence::Method::saltelli) {
            put("first_saltelli", factor.first_saltelli);
            put("total", factor.total);
        }
        if (factor.effects) {
            one["mu_star"] = {{"value", json_number(factor.effects->mu_star)},
                              {"error", json_number(factor.effects->mu_star_half_width)}};
            one["mu"] = json_number(factor.effects->mu);
            one["sigma"] = json_number(factor.effects->sigma);
        }
        one["trend"] = to_json(trend_cell(factor));
        put("rank_correlation", factor.rank_correlation);
        value["factors"].push_back(std::move(one));
    }
    const auto& split = influence.split;
    value["variance"] = {
        {"main_effects", json_of(split.main_effects)},    {"unexplained", json_of(split.unexplained)},
        {"interactions", json_of(split.interactions)},    {"scatter", json_of(split.scatter)},
        {"interactions_of_two", json_of(split.pairs)},    {"scatter_and_higher", json_of(split.remainder)},
        {"pure_error", json_number(split.pure.variance)}, {"pure_error_freedom", split.pure.freedom}};
    value["notes"] = influence.notes;
    return value;
}

}  // namespace grainsweep::report
