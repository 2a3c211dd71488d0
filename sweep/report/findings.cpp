#include "sweep/report/findings.hpp"

#include "sweep/campaign/experiments.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/study.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace grainsweep::report {

using namespace study;

namespace {

using designs::Bracket;
using designs::RefinedLevel;
using Cell = store::Table::Cell;

std::string measured(std::string_view what, std::string_view unit) {
    return unit.empty() || unit == "1" ? std::string(what) : fmt::format("{} {}", what, unit);
}

/// "0.61 ± 0.02 (4 runs)", "0.61 ± 0.02 (2 runs, 2 without an answer)".
std::string level_text(const RefinedLevel& level) {
    if (level.answers.empty()) return "-";
    return fmt::format("{} ({} run{}{})", with_error(level.mean(), level.half_width()), level.answers.size(),
                       level.answers.size() == 1 ? "" : "s",
                       level.unanswered == 0 ? "" : fmt::format(", {} without an answer", level.unanswered));
}

/// Every number in a column of its own.
store::Table brackets_rows(const Brackets& brackets, const std::string& campaign) {
    store::Table table;
    table.columns = {"campaign", "observable", "threshold", "factor"};
    table.columns.insert(table.columns.end(), brackets.others.begin(), brackets.others.end());
    table.columns.insert(table.columns.end(), {"low", "high", "mean_at_low", "error_at_low", "runs_at_low",
                                               "mean_at_high", "error_at_high", "runs_at_high", "runs", "state"});
    for (std::size_t c = 0; c < brackets.found.size(); ++c) {
        const auto& one = brackets.found[c];
        std::vector<Cell> row = {campaign, brackets.observable, brackets.threshold, brackets.factor};
        row.insert(row.end(), brackets.levels[c].begin(), brackets.levels[c].end());
        row.insert(row.end(), {one.low.value, one.high.value});
        for (const auto* level : {&one.low, &one.high})
            row.insert(row.end(), {to_cell(level->mean()), to_cell(level->half_width()),
                                   static_cast<std::int64_t>(level->answers.size())});
        row.insert(row.end(), {static_cast<std::int64_t>(one.runs), std::string(designs::to_string(one.state))});
        table.rows.push_back(std::move(row));
    }
    return table;
}

Result<results::crossings> brackets_json(const Brackets& brackets, const std::string& campaign) {
    const auto level = [](const RefinedLevel& at) {
        return Result<results::bracket_end>{{"value", at.value},
                                            {"mean", at.mean()},
                                            {"error", at.half_width()},
                                            {"runs", at.answers.size()},
                                            {"unanswered", at.unanswered}};
    };
    Json found = Json::array();
    for (std::size_t c = 0; c < brackets.found.size(); ++c) {
        const auto& one = brackets.found[c];
        Json levels = Json::object();
        for (std::size_t j = 0; j < brackets.others.size(); ++j) levels.add(brackets.others[j], brackets.levels[c][j]);
        found.push_back(Result<results::bracket>{{"levels", levels},
                                                 {"low", level(one.low)},
                                                 {"high", level(one.high)},
                                                 {"runs", one.runs},
                                                 {"state", designs::to_string(one.state)}});
    }
    return {{"campaign", campaign},
            {"factor", brackets.factor},
            {"observable", brackets.observable},
            {"threshold", brackets.threshold},
            {"width", brackets.width},
            {"brackets", found}};
}

Result<results::calibration> calibration_json(const CalibrationReport& report, const std::string& campaign) {
    const auto wave = [](const auto& one) {
        return Result<results::wave>{{"settings", one.settings}, {"cases", one.cases},
                                     {"failed", one.failed},     {"excluded", one.excluded},
                                     {"kept", one.kept},         {"model_errors", one.model_error}};
    };
    const auto factor = [](const study::FactorPosterior& one) {
        return Result<results::factor_posterior>{
            {"factor", one.factor.name},
            {"mean", one.mean},
            {"sd", one.sd},
            {"q05", one.low},
            {"q95", one.high},
            {"share_of_range", one.share_of_range},
            {"verdict", one.word()},
            {"levels", Json::list(one.levels, [](const study::LevelProbability& level) {
                 return Result<results::level_probability>{{"level", level.level}, {"probability", level.probability}};
             })}};
    };
    const auto target = [](const study::TargetCheck& one) {
        return Result<results::target_check>{{"experiment", one.experiment},
                                             {"observable", one.observable},
                                             {"condition", one.condition},
                                             {"value", one.value},
                                             {"error", one.error},
                                             {"discrepancy", one.discrepancy},
                                             {"predicted", one.predicted},
                                             {"predicted_sd", one.predicted_error},
                                             {"checked", one.checked},
                                             {"checked_sd", one.checked_sd},
                                             {"runs", one.runs},
                                             {"z", one.z.value_or(std::numeric_limits<double>::quiet_NaN())}};
    };
    const auto& found = report.found;
    return {{"campaign", campaign},
            {"ended", found.waves_end},
            {"why", found.why_they_end},
            {"verdict", report.verdict ? Json(report.verdict->sentence) : Json()},
            {"waves", Json::list(found.waves, wave)},
            {"posterior", Json::list(report.factors, factor)},
            {"correlation", found.shape ? Json(found.shape->correlation) : Json::array()},
            {"targets", Json::list(report.targets, target)},
            {"notes", report.notes}};
}

std::string calibration_line(const CalibrationReport& report) {
    const auto& found = report.found;
    if (found.waves.empty()) return "calibration: the first wave is not answered yet";
    const auto& last = found.waves.back();
    const auto waves = std::ranges::count(found.waves, false, &designs::CalibrationWave::of_checks);
    const auto done = fmt::format("calibration: {} wave{}, {} cases, {:.3g} % of the box kept", waves,
                                  waves == 1 ? "" : "s", last.cases, 100 * last.kept);
    if (!found.waves_end) return done + "; the next wave is not answered yet";
    return fmt::format("{}; {}{}", done, found.why_they_end,
                       report.verdict ? "; " + report.verdict->sentence : std::string());
}

store::Table waves_table(const CalibrationReport& report) {
    const bool excludes = !report.found.waves.empty() && report.found.waves.back().excluded > 0;
    store::Table table{{"wave", "settings", "cases", "failed"}, {}};
    if (excludes) table.columns.emplace_back("excluded");
    table.columns.emplace_back("kept");
    for (const auto& target : report.targets) table.columns.push_back(fmt::format("model error of {}", target.name()));
    std::int64_t number = 0;
    for (const auto& wave : report.found.waves) {
        std::vector<Cell> row = {wave.of_checks ? Cell("checks") : Cell(++number),
                                 static_cast<std::int64_t>(wave.settings), static_cast<std::int64_t>(wave.cases),
                                 static_cast<std::int64_t>(wave.failed)};
        if (excludes) row.emplace_back(static_cast<std::int64_t>(wave.excluded));
        row.emplace_back(fmt::format("{:.3g} %", 100 * wave.kept));
        for (const double error : wave.model_error)
            row.emplace_back(std::isfinite(error) ? fmt::format("{:.2g} sd", error) : std::string("no model"));
        table.rows.push_back(std::move(row));
    }
    return table;
}

store::Table posterior_table(const CalibrationReport& report) {
    store::Table table{{"factor", "unit", "mean", "sd", "5 %", "95 %", "width over range's", "verdict"}, {}};
    const auto number = [](double x, int digits) { return std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "-"; };
    for (const auto& factor : report.factors)
        table.rows.push_back({factor.factor.name, factor.factor.unit, number(factor.mean, 4), number(factor.sd, 2),
                              number(factor.low, 4), number(factor.high, 4),
                              fmt::format("{:.2f}", factor.share_of_range), std::string(factor.word())});
    return table;
}

/// Probabilities of levels; no rows: every factor is continuous.
store::Table level_probabilities(const CalibrationReport& report) {
    store::Table table{{"factor", "unit", "level", "probability"}, {}};
    for (const auto& factor : report.factors)
        for (const auto& one : factor.levels)
            table.rows.push_back(
                {factor.factor.name, factor.factor.unit, one.level, fmt::format("{:.3f}", one.probability)});
    return table;
}

store::Table targets_table(const CalibrationReport& report) {
    store::Table table{{"target", "unit", "measured", "discrepancy", "model", "fresh runs", "runs", "z"}, {}};
    const auto pair = [](double value, double error) {
        return std::isfinite(value) ? with_error(value, error) : std::string("-");
    };
    for (const auto& target : report.targets)
        table.rows.push_back({target.name(), target.unit, with_error(target.value, target.error),
                              fmt::format("{:.3g}", target.discrepancy), pair(target.predicted, target.predicted_error),
                              pair(target.checked, target.checked_sd), static_cast<std::int64_t>(target.runs),
                              target.z ? fmt::format("{:+.1f}", *target.z) : std::string("-")});
    return table;
}

}  // namespace

std::string brackets_line(const Brackets& brackets) {
    std::string counts;
    using enum Bracket::State;
    for (const auto state : {found, below, above, unanswered, open}) {
        const auto n = std::ranges::count(brackets.found, state, &Bracket::state);
        if (n == 0) continue;
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", n, designs::to_string(state));
    }
    const auto is_undecided = [&](const RefinedLevel& end) {
        return std::abs(end.mean() - brackets.threshold) <= end.half_width();
    };
    const auto undecided = std::ranges::count_if(brackets.found, [&](const Bracket& one) {
        return one.state == found && (is_undecided(one.low) || is_undecided(one.high));
    });
    return fmt::format("where {} passes {} along {}, to {}: {} of {}{}", brackets.observable, brackets.threshold,
                       brackets.factor, measured(fmt::format("{:.4g}", brackets.width), brackets.factor_unit), counts,
                       brackets.found.size(),
                       undecided == 0 ? std::string()
                                      : fmt::format("; {} of them with an end whose 95 % interval contains the "
                                                    "threshold: the crossing may lie beyond it",
                                                    undecided));
}

store::Table brackets_table(const Brackets& brackets) {
    store::Table table;
    table.columns = brackets.others;
    const std::string unit = brackets.factor_unit == "1" ? "" : fmt::format(" ({})", brackets.factor_unit);
    for (const char* end : {"from", "to"}) table.columns.push_back(fmt::format("{} {}{}", brackets.factor, end, unit));
    for (const char* end : {"from", "to"}) table.columns.push_back(fmt::format("{} at '{}'", brackets.observable, end));
    table.columns.insert(table.columns.end(), {"runs", "is"});
    for (std::size_t c = 0; c < brackets.found.size(); ++c) {
        const auto& one = brackets.found[c];
        std::vector<Cell> row(brackets.levels[c].begin(), brackets.levels[c].end());
        row.insert(row.end(), {one.low.value, one.high.value, level_text(one.low), level_text(one.high),
                               static_cast<std::int64_t>(one.runs), std::string(designs::to_string(one.state))});
        table.rows.push_back(std::move(row));
    }
    return table;
}

void say_calibration(Document& shown, const CalibrationReport& report) {
    shown.say(calibration_line(report));
    if (!report.found.waves.empty()) shown.say().show(waves_table(report));
    if (!report.factors.empty()) shown.say("\nposterior").show(posterior_table(report));
    if (const auto levels = level_probabilities(report); !levels.rows.empty())
        shown.say("\nposterior probability of each level").show(levels);
    shown.say("\ntargets (standard deviations: measurement, spread over the posterior, scatter of fresh runs)");
    shown.show(targets_table(report)).say_notes(report.notes);
}

Json page_of(const CalibrationReport& report) {
    const auto& found = report.found;
    Json factors = Json::array();
    for (std::size_t j = 0; j < found.factors.size(); ++j) {
        const auto& factor = found.factors[j];
        const auto [low, high, logarithmic] = factor.shown();
        factors.push_back({{"name", factor.name}, {"low", low}, {"high", high}});
    }
    return {{"says", calibration_line(report)},
            {"notes", report.notes},
            {"posterior", found.posterior ? columns_and_rows(posterior_table(report)) : Json()},
            {"levels", columns_and_rows(level_probabilities(report))},
            {"targets", columns_and_rows(targets_table(report))},
            {"waves", columns_and_rows(waves_table(report))},
            {"factors", factors}};
}

namespace {

Document document_of(const Brackets& brackets, const Responses& responses) {
    const auto& campaign = responses.campaign.name;
    Document shown{.rows = brackets_rows(brackets, campaign),
                   .value = brackets_json(brackets, campaign),
                   .alone = true,
                   .converged = true};
    shown.say(fmt::format("{}: {}; {}", campaign, brackets_line(brackets), outcome_line(responses)));
    shown.say().show(brackets_table(brackets));
    return shown;
}

Document document_of(const CalibrationReport& report, const Responses& responses) {
    Document shown{
        .rows = posterior_table(report), .value = calibration_json(report, responses.campaign.name), .alone = true};
    shown.converged = report.found.waves_end && report.found.posterior;
    shown.say(fmt::format("{}: {}", responses.campaign.name, outcome_line(responses)));
    say_calibration(shown, report);
    return shown;
}

/// Of an experiment whose calibration is shown with another one.
Document document_beside(const Responses& responses) {
    const auto& record = responses.campaign;
    const auto first = campaign::name_beside(record, campaign::experiments_of(record).front());
    Document shown{.value = Result<results::calibration_beside>{{"campaign", record.name}, {"shown_with", first}},
                   .alone = true,
                   .converged = true};
    shown.say(fmt::format("{}: {}; the calibration over all experiments is shown with {}", record.name,
                          outcome_line(responses), first));
    return shown;
}

}  // namespace

std::optional<Document> findings_document(const store::Store& store, const Responses& responses) {
    if (!campaign::shows_findings(responses.campaign)) return document_beside(responses);
    if (const auto brackets = brackets_of(store, responses.campaign)) return document_of(*brackets, responses);
    if (const auto report = calibration_report(store, responses.campaign)) return document_of(*report, responses);
    return std::nullopt;
}

}  // namespace grainsweep::report
