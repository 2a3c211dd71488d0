#include "sweep/cli/status_text.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/cli/progress.hpp"
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
                scene = report::cell_text(cells[j]);
            } else if (auto value = with_unit(column, cells[j]); !value.empty()) {
                lines.emplace_back(label_of(column), std::move(value));
                widest = std::max(widest, lines.back().first.size());
            }
        }
        out << fmt::format("{}{}: {}\n", row > 0 ? "\n" : "", name, scene);
        for (const auto& [label, value] : lines) out << fmt::format("  {:<{}}  {}\n", label, widest, value);
    }
}

}  // namespace grainsweep::cli
