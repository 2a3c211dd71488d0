#include "sweep/report/table.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/visible_text.hpp"
#include "sweep/report/text_layout.hpp"
#include "sweep/report/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace grainsweep::report {

namespace {

using Cell = store::Table::Cell;

/// No text of a database moves the cursor of a terminal or is computed by a spreadsheet.
std::string harmless(const std::string& text) {
    constexpr std::string_view formula = "=+-@\t\r";
    const bool computed = !text.empty() && formula.find(text.front()) != std::string_view::npos;
    return (computed ? "'" : "") + campaign::visible(text);
}

std::string in_csv(const std::string& given) {
    const std::string text = harmless(given);
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

void write_csv_line(std::ostream& out, const auto& cells) {
    for (std::size_t j = 0; j < cells.size(); ++j) out << (j > 0 ? "," : "") << in_csv(cells[j]);
    out << '\n';
}

/// A name can be there twice (SELECT a.mfr, b.mfr); an object's cannot.
std::vector<std::string> distinct(const std::vector<std::string>& columns) {
    std::vector<std::string> names;
    for (const auto& column : columns) {
        std::string name = column;
        for (int k = 2; std::ranges::find(names, name) != names.end(); ++k) name = fmt::format("{}_{}", column, k);
        names.push_back(std::move(name));
    }
    return names;
}

Json object_of(const std::vector<std::string>& names, const std::vector<Cell>& row) {
    Json object = Json::object();
    for (std::size_t j = 0; j < row.size(); ++j) object.add(names[j], to_json(row[j]));
    return object;
}

}  // namespace

std::string harmless_json(const Json& value) {
    std::string text = value.text();
    // JSON leaves DEL and U+0080 to U+009F as they are, and some terminals obey them.
    for (std::size_t at = 0; at < text.size(); ++at) {
        const auto c = static_cast<unsigned char>(text[at]);
        const auto next = at + 1 < text.size() ? static_cast<unsigned char>(text[at + 1]) : 0U;
        const bool wide = c == 0xC2U && next >= 0x80U && next < 0xA0U;
        if (c != 0x7FU && !wide) continue;
        text.replace(at, wide ? 2 : 1, fmt::format("\\u{:04x}", wide ? next : c));
    }
    return text;
}

std::optional<Format> format_named(std::string_view word) {
    if (word == "text") return Format::text;
    if (word == "csv") return Format::csv;
    if (word == "json") return Format::json;
    if (word == "xlsx") return Format::xlsx;
    return std::nullopt;
}

void write(std::ostream& out, const store::Table& table, Format format) {
    switch (format) {
        case Format::text:
            return write_text(out, table, text_width());
        case Format::csv:
        case Format::json:
        case Format::xlsx:
            break;
    }
    RowWriter writer(out, format);
    writer.begin(table.columns);
    for (const auto& row : table.rows) writer.add(row);
    writer.end();
}

void RowWriter::begin(const std::vector<std::string>& columns) {
    names_ = distinct(columns);
    if (format_ == Format::json)
        *out_ << '[';
    else
        write_csv_line(*out_, names_);
}

void RowWriter::add(const std::vector<Cell>& row) {
    if (format_ != Format::json) return write_csv_line(*out_, row);
    *out_ << (std::exchange(first_, false) ? "" : ",") << harmless_json(object_of(names_, row));
}

void RowWriter::end(bool part) {
    if (format_ == Format::json) *out_ << (part ? "]" : "]\n");
}

Json to_json(const Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell))
        return exact_in_a_double(*whole) ? Json(*whole) : Json(std::to_string(*whole));
    if (const auto* real = std::get_if<double>(&cell)) return *real;
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    return nullptr;
}

Json to_json(const store::Table& table) {
    const auto names = distinct(table.columns);
    return Json::list(table.rows, [&](const auto& row) { return object_of(names, row); });
}

Json to_json(const store::Table& table, std::size_t row) {
    return object_of(distinct(table.columns), table.rows[row]);
}

Json to_json(const Inputs& inputs) {
    Json object = Json::object();
    for (const auto& [name, value] : inputs) object.add(name, to_json(to_cell(value)));
    return object;
}

Json columns_and_rows(const store::Table& table) {
    const auto cells = [](const auto& row) { return Json::list(row, [](const Cell& cell) { return to_json(cell); }); };
    return {{"columns", table.columns}, {"rows", Json::list(table.rows, cells)}};
}

void write(std::ostream& out, const Json& value) {
    out << harmless_json(value) << '\n';
}

Cell to_cell(const Value& value) {
    return std::visit([](const auto& held) -> Cell { return held; }, value);
}

Cell to_cell(double number) {
    return std::isnan(number) ? Cell{} : Cell{number};
}

}  // namespace grainsweep::report
