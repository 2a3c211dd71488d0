#include "sweep/report/bracket_tables.hpp"

#include "sweep/report/table.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace grainsweep::report {

using namespace study;

namespace {

using designs::Bracket;
using designs::RefinedLevel;
using Cell = store::Table::Cell;

std::string with_unit(std::string_view what, std::string_view unit) {
    return unit.empty() || unit == "1" ? std::string(what) : fmt::format("{} {}", what, unit);
}

/// "0.61 ± 0.02 (4 runs)", "0.61 ± 0.02 (2 runs, 2 without an answer)".
std::string level_text(const RefinedLevel& level) {
    if (level.answers.empty()) return "-";
    return fmt::format("{} ({} run{}{})", with_error(level.mean(), level.half_width()), level.answers.size(),
                       level.answers.size() == 1 ? "" : "s",
                       level.unanswered == 0 ? "" : fmt::format(", {} without an answer", level.unanswered));
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
    return fmt::format("where {} passes {} along {}, to {}: {} of {}", brackets.observable, brackets.threshold,
                       brackets.factor, with_unit(fmt::format("{:.4g}", brackets.width), brackets.factor_unit), counts,
                       brackets.found.size());
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

nlohmann::ordered_json to_json(const Brackets& brackets) {
    using Json = nlohmann::ordered_json;
    Json value = {{"factor", brackets.factor},
                  {"observable", brackets.observable},
                  {"threshold", brackets.threshold},
                  {"width", brackets.width},
                  {"brackets", Json::array()}};
    const auto level = [](const RefinedLevel& at) {
        return Json{{"value", at.value},
                    {"mean", json_number(at.mean())},
                    {"error", json_number(at.half_width())},
                    {"runs", at.answers.size()},
                    {"unanswered", at.unanswered}};
    };
    for (std::size_t c = 0; c < brackets.found.size(); ++c) {
        const auto& one = brackets.found[c];
        Json levels = Json::object();
        for (std::size_t j = 0; j < brackets.others.size(); ++j) levels[brackets.others[j]] = brackets.levels[c][j];
        value["brackets"].push_back({{"levels", levels},
                                     {"low", level(one.low)},
                                     {"high", level(one.high)},
                                     {"runs", one.runs},
                                     {"state", designs::to_string(one.state)}});
    }
    return value;
}

}  // namespace grainsweep::report
