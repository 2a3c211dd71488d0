#include "sweep/cli/status_text.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/report/table.hpp"
#include "sweep/report/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <string>

namespace grainsweep::cli {

namespace {

using Cell = store::Table::Cell;

std::string counted(std::int64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool is_outcome(const std::string& column) {
    return campaign::outcome_named(column).has_value();
}

/// The value with its unit; empty: not worth a line.
std::string with_unit(const std::string& column, const Cell& cell) {
    if (std::holds_alternative<std::monostate>(cell)) return {};
    const auto* count = std::get_if<std::int64_t>(&cell);
    const auto* number = std::get_if<double>(&cell);
    if (count != nullptr && is_outcome(column)) return *count == 0 ? "" : counted(*count, "case");
    if (count != nullptr && (column == "cases" || column == "waiting")) return counted(*count, "case");
    if (column == "points" || column == "asked_points" || column == "asked_replicates")
        return {};  // shown in other columns
    if (count != nullptr && column == "candidates") return counted(*count, "point") + " of the design";
    if (count != nullptr && column == "dropped")
        return *count == 0 ? "" : counted(*count, "point") + " left out by where";
    if (count != nullptr && column == "replicates")
        return *count == 1 ? "" : counted(*count, "case") + " at each point";
    if (count != nullptr && column == "finished") return counted(*count, "case");
    if (count != nullptr && column == "stopped_at") return fmt::format("converged after {}", counted(*count, "point"));
    if (number != nullptr && column == "rate")
        return fmt::format("{} cases/s in the last run",
                           *number < 1000 ? fmt::format("{:.3g}", *number) : fmt::format("{:.0f}", *number));
    if (number != nullptr && column == "time_left") return *number == 0 ? "0 s" : duration(*number) + " at this rate";
    return report::cell_text(cell);
}

std::string label_of(std::string column) {
    std::ranges::replace(column, '_', ' ');
    return column;
}

}  // namespace

void write_status(std::ostream& out, const store::Table& status) {
    for (std::size_t row = 0; row < status.rows.size(); ++row) {
        const auto& cells = status.rows[row];
        std::string name, scene;
        std::vector<std::pair<std::string, std::string>> lines;
        std::size_t widest = 0;
        for (std::size_t j = 0; j < cells.size(); ++j) {
            const auto& column = status.columns[j];
            if (column == "campaign") {
                name = report::cell_text(cells[j]);
            } else if (column == "scene") {
                scene = shown_scene(report::cell_text(cells[j]));
            } else if (auto value = with_unit(column, cells[j]); !value.empty()) {
                lines.emplace_back(label_of(column), std::move(value));
                widest = std::max(widest, lines.back().first.size());
            }
        }
        out << fmt::format("{}{}: {}\n", row > 0 ? "\n" : "", name, scene);
        for (const auto& [label, value] : lines) out << fmt::format("  {:<{}}  {}\n", label, widest, value);
    }
}

store::Table running_cases(const store::Store& archive, const live::Now& now, std::size_t most) {
    store::Table table;
    const auto factors = archive.factor_order(now.campaign);
    table.columns = {"case", "point"};
    table.columns.insert(table.columns.end(), factors.begin(), factors.end());
    for (const char* name : {"done", "seconds", "attempt", "host"}) table.columns.emplace_back(name);
    const auto quoted = [](const std::string& name) {
        std::string text = "\"";
        for (const char c : name) text.append(c == '"' ? 2 : 1, c);
        return text += '"';
    };
    std::string columns = "point";
    for (const auto& factor : factors) columns += ", " + quoted(factor);
    const auto held = archive.campaigns();
    if (!std::ranges::count(held, now.campaign, &store::CampaignRecord::name)) return table;
    const auto rows = archive.rows_of(now.campaign);
    for (const auto& one : now.running) {
        if (table.rows.size() == most) break;
        auto& row = table.rows.emplace_back(std::vector<Cell>{one.case_id});
        const auto found = archive.query(
            fmt::format("SELECT {} FROM ({}) WHERE case_id = '{}' ORDER BY point LIMIT 1", columns, rows, one.case_id));
        for (std::size_t k = 0; k <= factors.size(); ++k)
            row.push_back(found.rows.empty() ? Cell{} : found.rows.front()[k]);
        row.push_back(one.share ? Cell{*one.share} : Cell{});
        row.push_back(one.seconds);
        row.push_back(one.attempt);
        row.push_back(one.host);
    }
    return table;
}

void write_now(std::ostream& out, const store::Store& archive, const live::Now& now) {
    constexpr std::size_t most_shown = 32;
    out << fmt::format("\na run of {} is under way on {} (process {}): {} of {} cases{}, {}{} left{}\n", now.campaign,
                       now.host, now.process, now.decided, now.questions,
                       now.failed > 0 ? fmt::format(", {} failed", now.failed) : "", now.at_most ? "at most " : "",
                       duration(now.seconds_left), now.judgement.empty() ? "" : "; " + now.judgement);
    if (now.running.empty()) return;
    auto table = running_cases(archive, now, most_shown);
    for (auto& row : table.rows) row[0] = std::get<std::string>(row[0]).substr(0, 12);
    report::write(out, table, report::Format::text);
    if (now.running.size() > most_shown) out << fmt::format("and {} more\n", now.running.size() - most_shown);
}

}  // namespace grainsweep::cli
