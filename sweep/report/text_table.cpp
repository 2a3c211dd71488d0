#include "sweep/report/text_table.hpp"

#include "sweep/report/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <ostream>
#include <string_view>
#include <vector>

namespace grainsweep::report {

namespace {

constexpr std::size_t gap = 2;           // between two columns
constexpr std::size_t narrow_text = 12;  // a column of sentences is not wrapped narrower
constexpr std::size_t short_cell = 24;   // shorter texts (0.2702 ± 0.0011) may be wrapped narrower
constexpr std::size_t whole_word = 32;   // longer words are cut; a case id is not
constexpr std::size_t shown_of_an_id = 12;
constexpr int fewest_digits = 6, most_digits = 12;
constexpr double least_difference = 1e-11;  // a smaller relative difference of two numbers is no difference
constexpr std::int64_t largest_exact = std::int64_t{1} << 53U;

/// Columns on how a case was computed are left out first, in this order.
constexpr std::array<std::string_view, 5> least_asked_for = {"seed", "wall_seconds", "attempts", "sequence", "case_id"};

struct Column {
    std::string name;
    std::vector<std::string> cells;
    bool numeric = true;
    std::size_t rank = 0;                ///< smaller: left out earlier
    std::size_t natural = 0, least = 0;  ///< widths
};

/// A heading is wrapped at spaces and behind underscores.
std::size_t longest_piece(std::string heading) {
    for (std::size_t at = 0; (at = heading.find('_', at)) != std::string::npos; at += 2) heading.insert(at + 1, " ");
    return longest_word(heading);
}

void measure(Column& column, std::size_t narrow = narrow_text) {
    std::size_t widest = 0, word = 0;
    for (const auto& cell : column.cells) {
        widest = std::max(widest, columns_of(cell));
        word = std::max(word, longest_word(cell));
    }
    const std::size_t heading = longest_piece(column.name);
    column.natural = std::max(widest, columns_of(column.name));
    column.least = column.numeric ? std::max(widest, heading)
                                  : std::min(column.natural,
                                             std::max({std::min(word, whole_word), std::min(widest, narrow), heading}));
}

/// One line of text of a cell, a number to so many digits.
std::string cell_with_digits(const store::Table::Cell& cell, int digits) {
    const auto* real = std::get_if<double>(&cell);
    return real == nullptr ? cell_text(cell) : fmt::format("{:.{}g}", *real == 0 ? 0 : *real, digits);
}

/// Digits that tell each number of a column from the one above it, unless they differ by rounding alone.
int digits_of(const store::Table& table, std::size_t column) {
    int digits = fewest_digits;
    const double* above = nullptr;
    for (const auto& row : table.rows) {
        const auto* real = std::get_if<double>(&row[column]);
        if (real == nullptr) continue;
        if (above != nullptr && std::abs(*real - *above) > least_difference * std::abs(*real))
            while (digits < most_digits && cell_with_digits(*real, digits) == cell_with_digits(*above, digits))
                ++digits;
        above = real;
    }
    return digits;
}

std::vector<Column> columns_in(const store::Table& table) {
    std::vector<Column> columns;
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
        Column column;
        column.name = cell_text(table.columns[j]);
        const auto place = std::ranges::find(least_asked_for, column.name);
        column.rank = place != least_asked_for.end() ? 1 + static_cast<std::size_t>(place - least_asked_for.begin())
                                                     : 1 + least_asked_for.size() + (table.columns.size() - j);
        const int digits = digits_of(table, j);
        for (const auto& row : table.rows) {
            column.cells.push_back(cell_with_digits(row[j], digits));
            column.numeric = column.numeric && !std::holds_alternative<std::string>(row[j]);
            const auto* whole = std::get_if<std::int64_t>(&row[j]);
            if (whole != nullptr && (*whole > largest_exact || *whole < -largest_exact)) column.rank = 0;
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

/// Widths within the limit. The space beyond the least widths is shared by the columns that need more.
std::vector<std::size_t> shared(const std::vector<Column>& columns, std::size_t width) {
    std::vector<std::size_t> widths;
    for (const auto& column : columns) widths.push_back(column.least);
    std::size_t left = width - sum_of(columns, &Column::least);
    for (bool wider = true; wider;) {
        wider = false;
        for (std::size_t j = 0; j < columns.size() && left > 0; ++j) {
            if (widths[j] >= columns[j].natural) continue;
            ++widths[j];
            --left;
            wider = true;
        }
    }
    return widths;
}

void write_rows(std::ostream& out, const std::vector<Column>& columns, const std::vector<std::size_t>& widths) {
    const std::size_t rows = columns.empty() ? 0 : columns.front().cells.size();
    for (std::size_t row = 0; row <= rows; ++row) {  // row 0: the headings, at the bottom of their lines
        std::vector<std::vector<std::string>> cells;
        std::size_t height = 1;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            cells.push_back(wrapped(row == 0 ? columns[j].name : columns[j].cells[row - 1], widths[j]));
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

bool is_case_id(const std::string& cell) {
    return cell.size() == 32 && std::ranges::all_of(cell, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// Takes the columns with one value in all rows out, and returns them as a note: "outcome completed, attempts 1".
std::string take_constants(std::vector<Column>& columns) {
    std::string note;
    std::erase_if(columns, [&](const Column& column) {
        const auto& value = column.cells.front();
        if (std::ranges::count(column.cells, value) < std::ssize(column.cells)) return false;
        note += fmt::format("{}{} {}", note.empty() ? "" : ", ", column.name, value.empty() ? "(empty)" : value);
        return true;
    });
    return note;
}

/// Takes the columns that do not fit out, and returns their names.
std::string leave_out(std::vector<Column>& columns, std::size_t width) {
    std::string names;
    while (columns.size() > 1 && sum_of(columns, &Column::least) > width) {
        const auto least = std::ranges::min_element(columns, {}, &Column::rank);
        names += (names.empty() ? "" : ", ") + (least->name.empty() ? "the unnamed" : least->name);
        columns.erase(least);
    }
    return names;
}

void write_narrow(std::ostream& out, std::vector<Column> columns, std::size_t width) {
    const auto too_wide = [&] { return sum_of(columns, &Column::least) > width; };
    std::vector<std::string> notes;
    if (too_wide() && columns.front().cells.size() > 1) {
        auto varying = columns;
        const auto constants = take_constants(varying);
        if (!constants.empty() && !varying.empty()) {
            columns = std::move(varying);
            notes.push_back("the same in every row: " + constants);
        }
    }
    std::vector<std::string> shortened;
    if (too_wide())
        for (auto& column : columns) {
            if (column.cells.empty() || !std::ranges::all_of(column.cells, is_case_id)) continue;
            for (auto& cell : column.cells) cell.resize(shown_of_an_id);
            measure(column);
            shortened.push_back(column.name);
        }
    if (too_wide())
        for (auto& column : columns)
            if (!column.numeric && column.natural <= short_cell) measure(column, 1);
    const auto gone = leave_out(columns, width);
    for (const auto& name : shortened)
        if (std::ranges::count(columns, name, &Column::name) > 0)
            notes.push_back(
                fmt::format("{}: the first {} of 32 digits, enough for explain and replay", name, shown_of_an_id));
    if (!gone.empty())
        notes.push_back(fmt::format("left out: {} (--wide shows all columns, --format csv writes them)", gone));
    if (too_wide()) columns.front().least = columns.front().natural = width;  // a single column, wrapped
    write_rows(out, columns, shared(columns, width));
    for (const auto& note : notes)
        for (const auto& line : wrapped(note, width)) out << line << '\n';
}

}  // namespace

std::string cell_text(const store::Table::Cell& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
    if (std::holds_alternative<double>(cell)) return cell_with_digits(cell, fewest_digits);
    if (std::holds_alternative<std::monostate>(cell)) return "";
    std::string line;
    for (const char c : std::get<std::string>(cell)) {  // a row stays a row, and no text moves the cursor of a terminal
        const bool control = static_cast<unsigned char>(c) < 0x20U || c == 0x7F;
        line += c == '\n' ? "\\n" : control ? "?" : std::string(1, c);
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
