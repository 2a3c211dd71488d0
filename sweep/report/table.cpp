#include "sweep/report/table.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/report/text_layout.hpp"
#include "sweep/report/text_table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace grainsweep::report {

namespace {

using Cell = store::Table::Cell;
using Json = nlohmann::ordered_json;

std::string in_csv(const std::string& text) {
    if (!text.empty() && text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

bool exact_in_a_double(std::int64_t whole) {
    constexpr std::int64_t limit = std::int64_t{1} << 53U;
    return whole >= -limit && whole <= limit;
}

/// 5_577_006_791_947_779_410: no reader takes it for a number and rounds it.
std::string grouped(std::int64_t whole) {
    std::string digits = std::to_string(whole);
    const std::size_t first = digits.front() == '-' ? 1 : 0;
    for (std::size_t at = digits.size(); at > first + 3;) digits.insert(at -= 3, "_");
    return digits;
}

std::string in_csv(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell))
        return exact_in_a_double(*whole) ? std::to_string(*whole) : grouped(*whole);
    if (const auto* real = std::get_if<double>(&cell)) return std::isnan(*real) ? "" : campaign::shortest(*real);
    if (std::holds_alternative<std::monostate>(cell)) return "";
    return in_csv(std::get<std::string>(cell));
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
            return write_text(out, table, text_width());
        case Format::csv:
            return write_csv(out, table);
        case Format::json:
            return write(out, to_json(table));
    }
}

Json to_json(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell))
        return exact_in_a_double(*whole) ? Json(*whole) : Json(std::to_string(*whole));
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

nlohmann::ordered_json to_json(const std::optional<bool>& flag) {
    return flag ? nlohmann::ordered_json(*flag) : nlohmann::ordered_json(nullptr);
}

}  // namespace grainsweep::report
