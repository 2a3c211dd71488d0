#include "sweep/report/convergence_tables.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/report/accuracy.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace grainsweep::report {

using namespace study;

namespace {

using Cell = store::Table::Cell;
constexpr std::size_t most_shown_checks = 20;

bool is_gate(const History& history, stats::Statistic statistic) {
    return std::ranges::find(history.settings.gates, stats::Gate{statistic}) != history.settings.gates.end();
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

store::Table no_checks() {
    return {columns_of(results::check), {}};
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

Result<results::estimate> estimate_json(double value, double error) {
    return {{"value", value}, {"error", error}};
}

Json provisional_of(const History& history) {
    if (!history.provisional) return nullptr;
    const auto& known = *history.provisional;
    Json statistics = Json::object();
    for (const auto statistic : stats::statistics)
        statistics.add(to_string(statistic), estimate_json(known.of(statistic).value, known.of(statistic).error));
    return Result<results::provisional_moments>{
        {"points", known.points}, {"values", known.count}, {"excluded", known.excluded}, {"statistics", statistics}};
}

/// Returns the text of an estimate with a model, with a mark if it is withdrawn.
std::string shown_estimate(const stats::AssistedStatistic& statistic, const stats::AssistedEstimate& estimate) {
    return (statistic.withdrawn ? "withdrawn: " : "") + with_error(estimate.value, estimate.half_width);
}

std::string key(stats::Statistic statistic) {
    return std::string(stats::to_string(statistic));
}

/// Returns a sentence on the population of both estimates, if some cases have no value.
std::string population_line(const Estimators& estimators) {
    return fmt::format(
        "{} of {} cases have no value: the estimates with a model are of the whole box, extrapolated into the settings "
        "that failed; the plain ones are of the cases that answer",
        estimators.without_value, estimators.without_value + estimators.assisted->cases);
}

/// Returns a value with at least the digits of its error.
Cell value_cell(double value, double error) {
    const double ratio = std::abs(value) / error;
    if (!(ratio > 1e5) || !std::isfinite(ratio)) return to_cell(value);
    return fmt::format("{:.{}g}", value, std::min(15, 2 + static_cast<int>(std::ceil(std::log10(ratio)))));
}

/// Returns the statistics of all settled points: value, 95 % error, the measure that the rule compares with the
/// tolerance, and whether this gate delays convergence.
store::Table statistics_table(const History& history) {
    store::Table table{{"statistic", "value", "error", "measure", "gate"}, {}};
    for (const auto statistic : stats::statistics) {
        const auto& all = history.all.of(statistic);
        const double measure = judged_check(history).of(statistic).measure;
        table.rows.push_back({std::string(to_string(statistic)), value_cell(all.value, all.error), to_cell(all.error),
                              percent(measure), gate_text(history, statistic)});
    }
    return table;
}

/// P(name > threshold), or the quantile.
std::string name_of_level(const stats::Level& level, std::string_view name) {
    if (const auto* quantile = std::get_if<stats::Quantile>(&level))
        return fmt::format("{:.6g} % quantile", 100 * quantile->probability);
    const auto& beyond = std::get<stats::Exceedance>(level);
    return fmt::format("P({} {} {:.6g})", name, beyond.above ? '>' : '<', beyond.threshold);
}

/// Limits of a probability over all cases, where those without a value may lie on either side; none: every case has
/// one, or the level is a quantile.
std::optional<std::pair<double, double>> counting_failures(const History& history, const stats::Level& level,
                                                           double value) {
    if (history.all.excluded == history.beyond || std::holds_alternative<stats::Quantile>(level)) return std::nullopt;
    const auto values = static_cast<double>(history.all.count + history.beyond);
    const auto failed = static_cast<double>(history.all.excluded - history.beyond);
    return std::pair{value * values / (values + failed), (value * values + failed) / (values + failed)};
}

const stats::LevelEstimate* with_model(const Estimators* estimators, const stats::Level& level) {
    if (estimators == nullptr || !estimators->assisted) return nullptr;
    const auto& levels = estimators->assisted->levels;
    const auto found = std::ranges::find(levels, level, &stats::LevelEstimate::level);
    return found == levels.end() || !std::isfinite(found->error) ? nullptr : &*found;
}

/// Returns one row per level; with a column for estimates with a model where there are any.
store::Table levels_table(const History& history, const ResponseColumn& response, const Estimators* estimators) {
    store::Table table{{"statistic", "value", "error", "measure", "gate"}, {}};
    const bool models = estimators != nullptr && estimators->assisted && !estimators->assisted->levels.empty();
    if (models) table.columns.emplace_back("with a model");
    for (const auto& [level, all] : history.all.levels) {
        const bool gate = std::ranges::find(history.settings.gates, stats::Gate{level}) != history.settings.gates.end();
        const auto measure =
            gate && !history.checks.empty() ? history.checks.back().of(stats::Gate{level}).measure : all.measure;
        std::vector<Cell> row = {name_of_level(level, response.name), value_cell(all.value, all.error),
                                 to_cell(all.error), percent(measure),
                                 !gate || history.checks.empty()        ? ""
                                 : measure < history.settings.tolerance ? "within"
                                                                        : "not within"};
        if (const auto* one = with_model(estimators, level); models)
            row.emplace_back(one == nullptr ? "-" : with_error(one->value, one->error));
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json levels_json(const History& history, const Estimators* estimators) {
    Json list = Json::array();
    for (const auto& [level, all] : history.all.levels) {
        const auto* one = with_model(estimators, level);
        const auto limits = counting_failures(history, level, all.value);
        list.push_back(Result<results::level>{
            {"statistic", stats::to_string(level)},
            {"value", all.value},
            {"error", all.error},
            {"measure", all.measure},
            {"model_assisted", one == nullptr ? Json() : estimate_json(one->value, one->error)},
            {"of_all_cases", limits ? Json(std::array{limits->first, limits->second}) : Json()}});
    }
    return list;
}

store::Table provisional_table(const History& history) {
    store::Table table{{"statistic", "value", "error"}, {}};
    if (!history.provisional) return table;
    for (const auto statistic : stats::statistics) {
        const auto& known = history.provisional->of(statistic);
        table.rows.push_back(
            {std::string(to_string(statistic)), value_cell(known.value, known.error), to_cell(known.error)});
    }
    return table;
}

/// Returns the checks, at most about 20 of them.
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

/// Returns the moments of lattices of one family, with their changes from the coarser lattice relative to the measures
/// of a rule.
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

/// Returns the same table for people: "2.679 (30 %)".
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

void say_history(Document& shown, const Responses& responses, const History& history,
                 std::span<const LatticeStep> lattices) {
    if (!responses.campaign.condition.empty()) shown.say("where: " + points_line(responses)).say();
    if (history.all.count > 0 || !history.provisional) shown.show(statistics_table(history)).say();
    if (history.provisional)
        shown
            .say(fmt::format("provisional: all {} finished cases, also behind gaps in the design; not judged",
                             responses.finished()))
            .show(provisional_table(history))
            .say();
    if (!history.checks.empty()) {
        const auto checks = checks_table(history);
        shown.show(checks);
        if (checks.rows.size() < history.checks.size())
            shown.say(fmt::format("({} checks; --format csv has them all)", history.checks.size()));
        shown.say();
    }
    if (!lattices.empty()) shown.show(lattice_lines(lattices)).say();
    shown.say(history.verdict).say_notes(history.warnings);
}

/// Adds quantiles and probabilities.
void say_levels(Document& shown, const ResponseColumn& response, const History& history, const Estimators* estimators) {
    if (history.all.count == 0) return;
    shown.say().show(levels_table(history, response, estimators));
    for (const auto& [level, all] : history.all.levels)
        if (const auto limits = counting_failures(history, level, all.value))
            shown.say(fmt::format("{}: {:.3g} to {:.3g} of all cases, wherever those without a value lie",
                                  name_of_level(level, response.name), limits->first, limits->second));
}

/// Adds both estimates of the moments, if the design allows the second one.
void say_estimators(Document& shown, const History& history, const Estimators& estimators) {
    shown.say();
    if (estimators.assisted)
        shown.say("moments with a response model beside the plain ones").show(estimators_table(history, estimators));
    for (const auto& line : estimator_lines(estimators)) shown.say(line);
}

}  // namespace

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

Result<results::converge> to_json(const Responses& responses, const ResponseColumn& response, const History& history,
                                  std::span<const LatticeStep> lattices) {
    const bool rule = history.has_rule;
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    const bool judged = rule && converged != history.checks.end();
    const auto& held_back = judged_check(history).held_back;
    Json gates = Json::array(), statistics = Json::object();
    if (rule)
        for (const auto& gate : history.settings.gates) gates.push_back(stats::to_string(gate));
    for (const auto statistic : stats::statistics) {
        const auto& all = history.all.of(statistic);
        statistics.add(
            stats::to_string(statistic),
            Result<results::judged_estimate>{
                {"value", all.value}, {"error", all.error}, {"measure", judged_check(history).of(statistic).measure}});
    }
    Result<results::converge> value = {
        {"campaign", responses.campaign.name},
        {"observable", response.name},
        {"unit", response.unit},
        {"design", responses.campaign.design},
        {"points", history.all.points},
        {"values", history.all.count},
        {"excluded", history.all.excluded},
        {"zero_share", history.all.zero_share},
        {"candidates", responses.candidates},
        {"dropped", responses.dropped()},
        {"asked", responses.rows()},
        {"finished", responses.finished()},
        {"provisional", provisional_of(history)},
        {"rule", rule ? Json(stats::to_string(history.settings.rule)) : Json()},
        {"tolerance", rule ? Json(history.settings.tolerance) : Json()},
        {"gates", gates},
        {"statistics", statistics},
        {"converged", judged},
        {"converged_at", judged ? Json(converged->points) : Json()},
        {"held_back_by", !judged && held_back ? Json(stats::to_string(*held_back)) : Json()},
        {"points_needed", judged_check(history).points_needed},
        {"verdict", history.verdict},
        {"notes", history.warnings},
        {"checks", to_json(checks_rows(responses, response, history))}};
    if (!lattices.empty()) value.add("lattices", to_json(lattice_table(lattices)));
    return value;
}

store::Table estimators_table(const History& history, const Estimators& estimators) {
    store::Table table{{"statistic", "plain", "with a model"}, {}};
    const bool scatter_known = !estimators.scatter_from.empty();
    if (scatter_known) table.columns.emplace_back("without scatter");
    if (!estimators.assisted) return table;
    for (const auto statistic : stats::assisted_statistics) {
        const auto& one = estimators.assisted->of(statistic);
        const auto& plain = history.all.of(statistic);
        std::vector<store::Table::Cell> row = {key(statistic), with_error(plain.value, plain.error),
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

Result<results::estimators> estimators_json(const History& history, const Estimators& estimators) {
    Json plain = Json::object(), with_model, without_scatter, shares;
    for (const auto statistic : stats::statistics)
        plain.add(key(statistic), estimate_json(history.all.of(statistic).value, history.all.of(statistic).error));
    const bool known = estimators.assisted.has_value();
    const bool scatter_known = known && !estimators.scatter_from.empty();
    if (known)
        for (const auto statistic : stats::assisted_statistics) {
            const auto& one = estimators.assisted->of(statistic);
            with_model.add(key(statistic), Result<results::assisted_estimate>{{"value", one.assisted.value},
                                                                              {"error", one.assisted.half_width},
                                                                              {"taken", one.takes_assisted},
                                                                              {"withdrawn", one.withdrawn}});
            if (scatter_known)
                without_scatter.add(key(statistic),
                                    Result<results::estimate_without_scatter>{{"value", one.without_scatter.value},
                                                                              {"error", one.without_scatter.half_width},
                                                                              {"withdrawn", one.withdrawn}});
        }
    if (scatter_known)
        for (std::size_t p = 0; const auto& moment : results::scatter_shares) {
            const auto& budget = estimators.assisted->budget[p++];
            shares.add(moment.name, budget.scatter / (budget.response + budget.scatter));
        }
    return {{"plain", plain},
            {"model_assisted", with_model},
            {"without_scatter", without_scatter},
            {"model_error", known ? Json(estimators.assisted->model_error) : Json()},
            {"features", estimators.features},
            {"scatter_from", scatter_known ? Json(estimators.scatter_from) : Json()},
            {"scatter_share", shares},
            {"note", known ? estimators.assisted->remark : estimators.refused},
            {"population", known && estimators.without_value > 0 ? population_line(estimators) : ""}};
}

Document convergence_document(const store::Store& store, const Responses& responses, const ResponseColumn& response,
                              Format format, std::span<const stats::Level> wanted, study::WithoutValue without) {
    const std::span<const stats::Level> levels =
        wanted.empty() ? std::span<const stats::Level>(study::shown_levels) : wanted;
    const auto history = history_of(responses, response, levels, without);
    const bool left_out = without == study::WithoutValue::left_out;
    const auto lattices = lattice_family(store, responses, response);
    Document shown{.rows = checks_rows(responses, response, history), .converged = history.converged.value_or(false)};
    for (auto& row : provisional_rows(responses, response, history).rows) shown.rows.rows.push_back(std::move(row));
    std::vector<stats::Level> estimated;
    for (const auto& [level, estimate] : history.all.levels) estimated.push_back(level);
    const auto corrected = study::corrected_of(store, responses.campaign);
    if (corrected) shown.converged = corrected->within;
    if (format == Format::json) {
        const auto estimators = estimators_of(store, responses, response, estimated);
        auto value = to_json(responses, response, history, lattices);
        value.add("distribution", levels_json(history, left_out ? &estimators : nullptr))
            .add("estimators", estimators_json(history, estimators));
        if (corrected) value.add("corrected", corrected_json(*corrected));
        shown.value = value;
    }
    if (format == Format::text) {
        shown.say(study_heading(responses, response)).say();
        say_history(shown, responses, history, lattices);
        const auto estimators =
            repeats(responses) ? std::optional(estimators_of(store, responses, response, estimated)) : std::nullopt;
        say_levels(shown, response, history, estimators && left_out ? &*estimators : nullptr);
        if (estimators) say_estimators(shown, history, *estimators);
        if (corrected) shown.say().show(corrected_table(*corrected)).say(corrected->verdict());
    }
    return shown;
}

}  // namespace grainsweep::report
