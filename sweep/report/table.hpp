// Rows for people and programs: one renderer for every command.
//
//   text  columns aligned, numbers to 6 digits, no line wider than the terminal (text_table.hpp); for reading
//   csv   cells quoted as in RFC 4180, lines ending in LF as shells want; an absent value is empty, an empty text is
//   "";
//         a text that begins with = + - @ gets an apostrophe before it, or a spreadsheet would take it for a formula;
//         control characters but line ends and tabs are written \x1b
//   json  a list of objects, keys in column order; an absent value, NaN and infinity are null
//
// A column whose name is there already is named with _2 in csv and json.
//
// Numbers in csv and json are the shortest that read back as the same double. Whole numbers beyond 2^53 (seeds) are
// text there, because jq, R and spreadsheets read every number as a double. They are "5577006791947779410" in json and
// 5_577_006_791_947_779_410 in csv, where only the characters mark a number. --seed takes both.
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

enum class Format { text, csv, json, xlsx };  // xlsx: of commands that write a workbook (workbook.hpp)

[[nodiscard]] std::optional<Format> format_named(std::string_view word);

/// Rows as they come, none kept: the bytes of write() of the whole table. csv and json; text needs to see all rows.
class RowWriter {
public:
    RowWriter(std::ostream& out, Format format) : out_(&out), format_(format) {}
    void begin(const std::vector<std::string>& columns);
    void add(const std::vector<store::Table::Cell>& row);
    /// Closes the table; with the line end that one value has on standard output, unless it is a part of a larger one.
    void end(bool part = false);

private:
    std::ostream* out_;
    Format format_;
    std::vector<std::string> names_;
    bool first_ = true;
};

/// Writes the table; json is exactly one value and a line end.
void write(std::ostream& out, const store::Table& table, Format format);

/// The table as a list of objects, to be part of a larger value.
[[nodiscard]] Json to_json(const store::Table& table);
[[nodiscard]] Json to_json(const store::Table& table, std::size_t row);
[[nodiscard]] Json to_json(const store::Table::Cell& cell);
[[nodiscard]] Json to_json(const Inputs& inputs);
/// {"columns": names, "rows": lists of cells}, as pages show a table.
[[nodiscard]] Json columns_and_rows(const store::Table& table);
/// One JSON value and a line end.
void write(std::ostream& out, const Json& value);
/// The value alone, without characters that a terminal obeys.
[[nodiscard]] std::string harmless_json(const Json& value);

[[nodiscard]] store::Table::Cell to_cell(const Value& value);
/// NaN is an absent value.
[[nodiscard]] store::Table::Cell to_cell(double number);
[[nodiscard]] inline store::Table::Cell to_cell(const std::optional<std::int64_t>& count) {
    return count ? store::Table::Cell{*count} : store::Table::Cell{};
}

}  // namespace grainsweep::report
