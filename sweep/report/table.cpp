#include "sweep/report/table.hpp"

#include "sweep/campaign/case.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace grainsweep::report {

namespace {

using Cell = store::Table::Cell;
using Json = nlohmann::ordered_json;

std::string in_text(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
    if (const auto* real = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *real == 0 ? 0 : *real);
    if (std::holds_alternative<std::monostate>(cell)) return "";
    std::string line;
    for (const char c : std::get<std::string>(cell)) {
        // A row stays a row, and no text of a database moves the cursor of a terminal.
        if (c == '\n') {
            line += "\\n";
        } else if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) {
            line += '?';
        } else {
            line += c;
        }
    }
    return line;
}

std::string in_csv(const std::string& text) {
    if (!text.empty() && text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string in_csv(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
    if (const auto* real = std::get_if<double>(&cell)) return std::isnan(*real) ? "" : campaign::shortest(*real);
    if (std::holds_alternative<std::monostate>(cell)) return "";
    return in_csv(std::get<std::string>(cell));
}

/// Characters, not bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void write_text(std::ostream& out, const store::Table& table) {
    std::vector<std::vector<std::string>> lines = {table.columns};
    for (const auto& row : table.rows) {
        auto& line = lines.emplace_back();
        for (const auto& cell : row) line.push_back(in_text(cell));
    }
    const std::size_t columns = table.columns.size();
    std::vector<std::size_t> widths(columns, 0);
    std::vector<bool> numeric(columns, true);  // numbers are aligned to the right
    for (std::size_t j = 0; j < columns; ++j) {
        for (const auto& line : lines) widths[j] = std::max(widths[j], width_of(line[j]));
        for (const auto& row : table.rows) numeric[j] = numeric[j] && !std::holds_alternative<std::string>(row[j]);
    }
    for (const auto& line : lines) {
        std::string text;
        for (std::size_t j = 0; j < columns; ++j) {
            const std::string padding(widths[j] - width_of(line[j]), ' ');
            if (j > 0) text += "  ";
            text += numeric[j] ? padding + line[j] : line[j] + padding;
        }
        text.erase(text.find_last_not_of(' ') + 1);
        out << text << '\n';
    }
}

void write_csv(std::ostream& out, const store::Table& table) {
    const auto write_line = [&out](const auto& cells) {
        for (std::size_t j = 0; j < cells.size(); ++j) out << (j > 0 ? "," : "") << in_csv(cells[j]);
        out << '\n';
    };
    write_line(table.columns);
    for (const auto& row : table.rows) write_line(row);
}

}  // namespace

std::optional<Format> format_named(std::string_view word) {
    if (word == "text") return Format::text;
    if (word == "csv") return Format::csv;
    if (word == "json") return Format::json;
    return std::nullopt;
}

void write(std::ostream& out, const store::Table& table, Format format) {
    switch (format) {
        case Format::text:
            return write_text(out, table);
        case Format::csv:
            return write_csv(out, table);
        case Format::json:
            return write(out, to_json(table));
    }
}

Json to_json(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return *whole;
    if (const auto* real = std::get_if<double>(&cell)) return std::isfinite(*real) ? Json(*real) : Json(nullptr);
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    return nullptr;
}

Json to_json(const store::Table& table) {
    // A name can be there twice (SELECT a.mfr, b.mfr); an object's cannot.
    std::vector<std::string> names;
    for (const auto& column : table.columns) {
        std::string name = column;
        for (int k = 2; std::ranges::find(names, name) != names.end(); ++k) name = fmt::format("{}_{}", column, k);
        names.push_back(std::move(name));
    }
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json object = Json::object();
        for (std::size_t j = 0; j < row.size(); ++j) object[names[j]] = to_json(row[j]);
        rows.push_back(std::move(object));
    }
    return rows;
}

void write(std::ostream& out, const Json& value) {
    out << value.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

Cell to_cell(const Value& value) {
    return std::visit([](const auto& held) -> Cell { return held; }, value);
}

Cell to_cell(double number) {
    return std::isnan(number) ? Cell{} : Cell{number};
}

}  // namespace grainsweep::report
