#include "sweep/report/text_table.hpp"

#include "sweep/report/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <ostream>
#include <string_view>
#include <vector>

namespace grainsweep::report {

namespace {

using Cell = store::Table::Cell;

constexpr std::size_t gap = 2;            // between two columns
constexpr std::size_t narrow_text = 12;   // a column of text is not wrapped narrower
constexpr std::size_t longest_word = 32;  // of a cell that is kept whole: a name, a case id
constexpr std::size_t shown_of_an_id = 12;
constexpr std::size_t most_records = 3;
constexpr std::int64_t largest_exact = std::int64_t{1} << 53U;

struct Column {
    std::string name;
    std::vector<std::string> cells;
    bool numeric = true;
    bool huge = false;       ///< whole numbers beyond 2^53
    bool shortened = false;  ///< case ids by their beginning
    std::size_t natural = 0, least = 0;
};

/// A heading in pieces that may stand below each other: "time_" "left".
std::vector<std::string> pieces_of(const std::string& name) {
    std::vector<std::string> pieces(1);
    for (const char c : name) {
        if (c == ' ') {
            pieces.emplace_back();
            continue;
        }
        pieces.back() += c;
        if (c == '_') pieces.emplace_back();
    }
    std::erase(pieces, "");
    return pieces;
}

/// The heading in lines, pieces joined while they fit.
std::vector<std::string> heading_lines(const std::string& name, std::size_t width) {
    if (columns_of(name) <= width) return {name};
    std::vector<std::string> lines;
    for (const auto& piece : pieces_of(name)) {
        const bool spaced = !lines.empty() && !lines.back().ends_with('_');
        if (!lines.empty() && columns_of(lines.back()) + columns_of(piece) + (spaced ? 1 : 0) <= width) {
            lines.back() += (spaced ? " " : "") + piece;
        } else {
            for (const auto& part : wrapped(piece, width)) lines.push_back(part);
        }
    }
    return lines;
}

std::size_t longest_piece(const std::vector<std::string>& pieces) {
    std::size_t longest = 0;
    for (const auto& piece : pieces) longest = std::max(longest, columns_of(piece));
    return longest;
}

/// Short cells (0.2702 ± 0.0011) may be wrapped narrower than sentences.
constexpr std::size_t short_cell = 24;

void measure(Column& column, std::size_t narrow = narrow_text) {
    std::size_t widest = 0, word = 0;
    for (const auto& cell : column.cells) {
        widest = std::max(widest, columns_of(cell));
        if (column.numeric) continue;
        for (const auto& whole : unbroken(cell)) word = std::max(word, columns_of(whole));
    }
    const std::size_t heading = longest_piece(pieces_of(column.name));
    column.natural = std::max(widest, columns_of(column.name));
    column.least =
        column.numeric
            ? std::max(widest, heading)
            : std::min(column.natural, std::max({std::min(word, longest_word), std::min(widest, narrow), heading}));
}

std::vector<Column> columns_in(const store::Table& table) {
    std::vector<Column> columns;
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
        Column column;
        column.name = cell_text(table.columns[j]);
        for (const auto& row : table.rows) {
            column.cells.push_back(cell_text(row[j]));
            column.numeric = column.numeric && !std::holds_alternative<std::string>(row[j]);
            const auto* whole = std::get_if<std::int64_t>(&row[j]);
            column.huge = column.huge || (whole != nullptr && (*whole > largest_exact || *whole < -largest_exact));
        }
        measure(column);
        columns.push_back(std::move(column));
    }
    return columns;
}

std::size_t sum_of(const std::vector<Column>& columns, std::size_t Column::*width) {
    std::size_t sum = columns.empty() ? 0 : gap * (columns.size() - 1);
    for (const auto& column : columns) sum += column.*width;
    return sum;
}

/// Widths within the limit: what is left above the least is shared, the smallest needs first. Their least must fit.
std::vector<std::size_t> shared(const std::vector<Column>& columns, std::size_t width) {
    std::vector<std::size_t> widths, order(columns.size());
    for (const auto& column : columns) widths.push_back(column.least);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto need = [&](std::size_t j) { return columns[j].natural - columns[j].least; };
    std::ranges::stable_sort(order, {}, need);
    std::size_t left = width - sum_of(columns, &Column::least);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t given = std::min(need(order[k]), left / (order.size() - k));
        widths[order[k]] += given;
        left -= given;
    }
    return widths;
}

void write_rows(std::ostream& out, const std::vector<Column>& columns, const std::vector<std::size_t>& widths) {
    const std::size_t rows = columns.empty() ? 0 : columns.front().cells.size();
    for (std::size_t row = 0; row <= rows; ++row) {  // row 0: the headings, at the bottom of their lines
        std::vector<std::vector<std::string>> cells;
        std::size_t height = 1;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            cells.push_back(row == 0             ? heading_lines(columns[j].name, widths[j])
                            : columns[j].numeric ? std::vector{columns[j].cells[row - 1]}
                                                 : wrapped(columns[j].cells[row - 1], widths[j]));
            height = std::max(height, cells.back().size());
        }
        for (std::size_t line = 0; line < height; ++line) {
            std::string text;
            for (std::size_t j = 0; j < columns.size(); ++j) {
                const std::size_t above = row == 0 ? height - cells[j].size() : 0;
                const bool here = line >= above && line - above < cells[j].size();
                const std::string part = here ? cells[j][line - above] : "";
                const std::string padding(widths[j] - std::min(widths[j], columns_of(part)), ' ');
                if (j > 0) text += std::string(gap, ' ');
                text += columns[j].numeric ? padding + part : part + padding;
            }
            text.erase(text.find_last_not_of(' ') + 1);
            out << text << '\n';
        }
    }
}

void write_note(std::ostream& out, const std::string& note, std::size_t width) {
    for (const auto& line : wrapped(note, width)) out << line << '\n';
}

bool is_case_id(const std::string& cell) {
    return cell.size() == 32 && std::ranges::all_of(cell, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

bool holds_ids(const Column& column) {
    return !column.cells.empty() && std::ranges::all_of(column.cells, is_case_id);
}

void write_records(std::ostream& out, const std::vector<Column>& columns, std::size_t width) {
    std::size_t label = 0;
    for (const auto& column : columns) label = std::max(label, columns_of(column.name));
    label = std::min(label, width / 2);
    for (std::size_t row = 0; row < columns.front().cells.size(); ++row) {
        if (row > 0) out << '\n';
        for (const auto& column : columns) {
            const auto names = wrapped(column.name, label);
            const auto values = wrapped(column.cells[row], width - label - gap);
            for (std::size_t line = 0; line < std::max(names.size(), values.size()); ++line) {
                std::string text = line < names.size() ? names[line] : "";
                text += std::string(label + gap - columns_of(text), ' ');
                if (line < values.size()) text += values[line];
                text.erase(text.find_last_not_of(' ') + 1);
                out << text << '\n';
            }
        }
    }
}

/// Takes out the columns for which `taken` holds and returns them.
template <class Taken>
std::vector<Column> take(std::vector<Column>& columns, const Taken& taken) {
    std::vector<Column> out;
    std::erase_if(columns, [&](Column& column) {
        if (!taken(column)) return false;
        out.push_back(std::move(column));
        return true;
    });
    return out;
}

std::string names_of(const std::vector<Column>& columns) {
    std::string names;
    for (const auto& column : columns)
        names += (names.empty() ? "" : ", ") + (column.name.empty() ? "the unnamed" : column.name);
    return names;
}

/// "the same in every row: sequence 0, outcome completed".
std::string note_of_constants(const std::vector<Column>& constants) {
    std::string same, empty;
    for (const auto& column : constants) {
        const auto& value = column.cells.front();
        auto& list = value.empty() ? empty : same;
        list += (list.empty() ? "" : ", ") + column.name + (value.empty() ? "" : " " + value);
    }
    std::string note;
    if (!same.empty()) note = "the same in every row: " + same;
    if (!empty.empty()) note += (note.empty() ? "" : "; ") + std::string("empty in every row: ") + empty;
    return note;
}

/// How a case was computed rather than what was asked and answered: left out first, in this order.
constexpr std::array<std::string_view, 5> least_asked_for = {"seed", "wall_seconds", "attempts", "sequence", "case_id"};

/// Smaller: left out earlier.
std::size_t rank_of(const Column& column, std::size_t place, std::size_t columns) {
    if (column.huge) return 0;
    const auto found = std::ranges::find(least_asked_for, column.name);
    if (found != least_asked_for.end()) return 1 + static_cast<std::size_t>(found - least_asked_for.begin());
    return 1 + least_asked_for.size() + (columns - place);
}

std::vector<Column> leave_out(std::vector<Column>& columns, std::size_t width) {
    std::vector<std::size_t> order(columns.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t j) { return rank_of(columns[j], j, columns.size()); });
    std::vector<bool> out(columns.size(), false);
    std::size_t total = sum_of(columns, &Column::least);
    for (std::size_t k = 0; k + 1 < order.size() && total > width; ++k) {
        out[order[k]] = true;
        total -= columns[order[k]].least + gap;
    }
    std::vector<Column> gone, kept;
    for (std::size_t j = 0; j < columns.size(); ++j) (out[j] ? gone : kept).push_back(std::move(columns[j]));
    columns = std::move(kept);
    return gone;
}

void write_narrow(std::ostream& out, std::vector<Column> columns, std::size_t width) {
    const auto too_wide = [&] { return sum_of(columns, &Column::least) > width; };
    const std::size_t rows = columns.front().cells.size();
    const std::vector<Column> all = columns;
    std::vector<std::string> notes;
    if (too_wide() && rows > 1) {
        const auto constants = take(columns, [](const Column& c) {
            return std::ranges::count(c.cells, c.cells.front()) == std::ssize(c.cells);
        });
        if (columns.empty())
            columns = all;
        else if (!constants.empty())
            notes.push_back(note_of_constants(constants));
    }
    if (too_wide()) {
        for (auto& column : columns) {
            if (!holds_ids(column)) continue;
            for (auto& cell : column.cells) cell.resize(shown_of_an_id);
            measure(column);
            column.shortened = true;
        }
    }
    if (too_wide() && rows > 0 && rows <= most_records) return write_records(out, all, width);
    if (too_wide())
        for (auto& column : columns)
            if (!column.numeric && column.natural <= short_cell) measure(column, 1);
    const auto gone = leave_out(columns, width);
    for (const auto& column : columns)
        if (column.shortened)
            notes.push_back(fmt::format("{}: the first {} of 32 digits, which explain and replay take", column.name,
                                        shown_of_an_id));
    if (!gone.empty())
        notes.push_back(
            fmt::format("left out: {} (--wide shows all columns, --format csv writes them)", names_of(gone)));
    if (too_wide()) columns.front().least = columns.front().natural = width;  // a single column, wrapped
    write_rows(out, columns, shared(columns, width));
    for (const auto& note : notes) write_note(out, note, width);
}

}  // namespace

std::string cell_text(const Cell& cell) {
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

void write_text(std::ostream& out, const store::Table& table, std::size_t width) {
    const auto columns = columns_in(table);
    if (columns.empty() || sum_of(columns, &Column::natural) <= width) {
        std::vector<std::size_t> widths;
        for (const auto& column : columns) widths.push_back(column.natural);
        return write_rows(out, columns, widths);
    }
    write_narrow(out, columns, width);
}

}  // namespace grainsweep::report
