// Writer of tables for people and programs, used by every command.
//
//   text  columns aligned, numbers to 6 digits, no line wider than the terminal (text_table.hpp); for people
//   csv   cells quoted as in RFC 4180, lines ending in LF. An absent value is empty, an empty text is "". A text that
//         begins with = + - @ gets an apostrophe before it, because spreadsheets would take it for a formula. Control
//         characters except line ends and tabs are written as \x1b
//   json  a list of objects, keys in column order; an absent value, NaN and infinity are null
//
// A column whose name is repeated gets the suffix _2 in csv and json.
//
// Numbers in csv and json are the shortest that read back as the same double. Whole numbers beyond 2^53 (seeds) are
// written as text, because jq, R and spreadsheets read every number as a double: "5577006791947779410" in json, and
// 5_577_006_791_947_779_410 in csv, where quotes would not mark a text. --seed accepts both.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/json_writer.hpp"
#include "sweep/store/store.hpp"

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

using Json = campaign::JsonText;

enum class Format { text, csv, json, xlsx };  // xlsx: for commands that write a workbook (workbook.hpp)

[[nodiscard]] std::optional<Format> format_named(std::string_view word);

/// Writer of single rows without storing them, with the same bytes as write() of the whole table. For csv and json;
/// text needs all rows.
class RowWriter {
public:
    RowWriter(std::ostream& out, Format format) : out_(&out), format_(format) {}
    void begin(const std::vector<std::string>& columns);
    void add(const std::vector<store::Table::Cell>& row);
    /// Ends the table, with a line end unless it is a part of a larger value.
    void end(bool part = false);

private:
    std::ostream* out_;
    Format format_;
    std::vector<std::string> names_;
    bool first_ = true;
};

/// Writes the table; json is one value and a line end.
void write(std::ostream& out, const store::Table& table, Format format);

/// Returns the table as a list of objects, for a larger value.
[[nodiscard]] Json to_json(const store::Table& table);
[[nodiscard]] Json to_json(const store::Table& table, std::size_t row);
[[nodiscard]] Json to_json(const store::Table::Cell& cell);
[[nodiscard]] Json to_json(const Inputs& inputs);
/// Returns {"columns": names, "rows": lists of cells}, for pages.
[[nodiscard]] Json columns_and_rows(const store::Table& table);
/// Writes one JSON value and a line end.
void write(std::ostream& out, const Json& value);
/// Returns the value without control characters of terminals.
[[nodiscard]] std::string harmless_json(const Json& value);

[[nodiscard]] store::Table::Cell to_cell(const Value& value);
/// Returns a cell; NaN is an absent value.
[[nodiscard]] store::Table::Cell to_cell(double number);
[[nodiscard]] inline store::Table::Cell to_cell(const std::optional<std::int64_t>& count) {
    return count ? store::Table::Cell{*count} : store::Table::Cell{};
}

}  // namespace grainsweep::report
