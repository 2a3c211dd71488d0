// From the text of an export to rows of cells: separator, decimal sign, the blocks of numbers and their headers.
#include "sweep/campaign/powder_export_blocks.hpp"

#include "solver/plain_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace grainsweep::campaign::export_blocks {
namespace {

constexpr std::size_t longest_line = 16U << 10U;
constexpr std::size_t most_headers = 3;  // lines above a block that may name its columns

Cells quoted_cells(std::string_view line, char separator) {
    Cells cells(1);
    bool quoted = false;
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (line[k] == '"')
            quoted = !quoted;
        else if (!quoted && line[k] == separator) {
            if (separator != ' ' || !cells.back().empty()) cells.emplace_back();
        } else {
            cells.back() += line[k];
        }
    }
    return cells;
}

/// Visits the cells of a line without quotes until visit() returns false; a blank as separator stands for any number of
/// blanks.
template <class Visit>
bool every_cell(std::string_view line, char separator, const Visit& visit) {
    if (separator == ' ') line = trimmed(line);
    std::size_t count = 0;
    for (auto end = line.find(separator); end != std::string_view::npos; end = line.find(separator)) {
        if ((separator != ' ' || end > 0) && !visit(count++, trimmed(line.substr(0, end)))) return false;
        line.remove_prefix(end + 1);
    }
    return visit(count, trimmed(line));
}

bool is_gap(std::string_view cell) {
    return cell.empty() || cell == "-" || cell == "--" || cell == "n/a" || cell == "N/A" || cell == "n.a.";
}

/// What a line holds as a row: two or more numbers, and nothing else but gaps, sizes and one name in front.
struct RowLook {
    std::size_t numbers = 0, names = 0, width = 0, first_number = 0;
    bool other = false;

    void see(std::size_t k, std::string_view cell, bool decimal_comma) {
        if (is_gap(cell)) return;
        width = k + 1;
        if (export_number(cell, decimal_comma) || (k < 3 && export_size(cell, decimal_comma))) {
            if (numbers++ == 0) first_number = k;
        } else if (k == 0) {
            ++names;
        } else {
            other = true;
        }
    }
    [[nodiscard]] bool row() const { return !other && numbers >= 2 && numbers > names; }
    /// Only a size, as the last edge of classes.
    [[nodiscard]] bool edge() const { return !other && names == 0 && numbers == 1; }
};

RowLook look_at(std::string_view line, char separator, bool decimal_comma) {
    RowLook look;
    if (line.size() > longest_line) return {.other = true};
    if (line.find('"') != std::string_view::npos) {
        const Cells cells = cells_of_line(line, separator);
        for (std::size_t k = 0; k < cells.size() && !look.other; ++k) look.see(k, cells[k], decimal_comma);
        return look;
    }
    every_cell(line, separator, [&](std::size_t k, std::string_view cell) {
        look.see(k, cell, decimal_comma);
        return !look.other;
    });
    return look;
}

/// Cells of a line that may name columns; of a table with blanks, names are apart by two blanks or a tabulator.
Cells header_cells(const std::string& line, const Block& block) {
    if (block.separator != ' ') return cells_of_line(line, block.separator);
    Cells cells(1);
    const std::string_view text = trimmed(line);
    for (std::size_t k = 0; k < text.size(); ++k) {
        const bool apart = text[k] == '\t' || (text[k] == ' ' && k + 1 < text.size() && text[k + 1] == ' ');
        if (!apart)
            cells.back() += text[k];
        else if (!trimmed(cells.back()).empty())
            cells.emplace_back();
    }
    for (auto& cell : cells) cell = std::string(trimmed(cell));
    return cells.size() == block.width ? cells : cells_of_line(line, ' ');
}

/// Whether a cell stands below the name of a column, as its unit.
bool is_unit(const std::string& cell) {
    constexpr auto units = std::to_array<std::string_view>(
        {"",       "-",    "1",     "um",      "mm",      "nm",           "m",    "micron", "microns", "%",
         "vol.-%", "vol%", "vol.%", "volume%", "number%", "surfacearea%", "wt%",  "mass%",  "g",       "kg",
         "mg",     "%/um", "1/um",  "phi",     "mesh",    "astm",         "tyler"});
    std::string plain = plain_words(cell);
    std::erase_if(plain, [](char c) { return std::string_view("()[] ").find(c) != std::string_view::npos; });
    return std::ranges::find(units, plain) != units.end();
}

std::size_t filled(const Cells& cells) {
    return static_cast<std::size_t>(std::ranges::count_if(cells, [](const auto& cell) { return !cell.empty(); }));
}

/// Names of samples in a line above headers that repeat: each stands until the next.
void add_names(const Cells& names, std::vector<std::string>& headers) {
    std::string name;
    const auto plain = headers;
    for (std::size_t j = 0; j < headers.size(); ++j) {
        if (j < names.size() && !names[j].empty()) name = names[j];
        const bool repeats = std::ranges::count(plain, plain[j]) > 1;
        if (!name.empty() && !headers[j].empty() && repeats) headers[j] = name + ": " + headers[j];
    }
}

bool repeats_headers(const std::vector<std::string>& headers) {
    for (std::size_t j = 1; j < headers.size(); ++j)
        if (!headers[j].empty() && std::find(headers.begin(), headers.begin() + static_cast<std::ptrdiff_t>(j),
                                             headers[j]) != headers.begin() + static_cast<std::ptrdiff_t>(j))
            return true;
    return false;
}

}  // namespace

Lines lines_of(const std::string& text) {
    Lines lines(1);
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '\n' || text[k] == '\r') {
            if (text[k] == '\r' && k + 1 < text.size() && text[k + 1] == '\n') ++k;
            lines.emplace_back();
        } else {
            lines.back() += text[k];
        }
    }
    for (auto& line : lines)  // no-break spaces
        for (std::size_t at = 0; (at = line.find("\xC2\xA0", at)) != std::string::npos;) line.replace(at, 2, " ");
    return lines;
}

Cells cells_of_line(std::string_view line, char separator) {
    if (line.size() > longest_line) return {};
    if (separator == ' ') line = trimmed(line);
    Cells cells;
    if (line.find('"') == std::string_view::npos)
        every_cell(line, separator, [&](std::size_t, std::string_view cell) {
            cells.emplace_back(cell);
            return true;
        });
    else
        cells = quoted_cells(line, separator);
    for (auto& cell : cells) cell = std::string(trimmed(cell));
    while (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

std::vector<Block> blocks_of(const Lines& lines, char separator, bool decimal_comma) {
    std::vector<Block> all;
    Block run{separator, decimal_comma};
    std::size_t size_column = 0;
    RowLook before;
    for (std::size_t k = 0; k <= lines.size(); ++k) {
        const RowLook look = k < lines.size() ? look_at(lines[k], separator, decimal_comma) : RowLook{};
        const bool edge = look.edge() && run.rows >= 2 && look.first_number == size_column;
        if (!look.row() && !edge) {
            if (run.rows >= 2) all.push_back(run);
            run = {separator, decimal_comma, k + 1};
            before = look;
            continue;
        }
        if (run.rows == 0 && before.edge() && before.first_number == look.first_number) {
            --run.first;  // the first line has only a size: the upper edge of falling classes
            ++run.rows;
        }
        before = {};
        size_column = look.first_number;
        ++run.rows;
        run.width = std::max(run.width, look.width);
        run.numbers += look.numbers;
    }
    return all;
}

std::size_t read_headers(const Lines& lines, const Block& block, std::vector<std::string>& headers) {
    headers.assign(block.width, {});
    std::size_t from = block.first;
    bool units_only = true;
    for (std::size_t k = block.first; k-- > 0 && block.first - k <= most_headers && units_only;) {
        std::string line = lines[k];
        if (line.starts_with('#')) line.erase(0, line.find_first_not_of("# "));  // of a comment
        if (from == block.first && trimmed(line).empty()) continue;
        const Cells cells = header_cells(line, block);
        if (filled(cells) < 2 || cells.size() > block.width ||
            look_at(lines[k], block.separator, block.decimal_comma).row())
            break;
        for (std::size_t j = 0; j < cells.size(); ++j)
            if (!cells[j].empty()) headers[j] = cells[j] + (headers[j].empty() ? "" : " " + headers[j]);
        units_only = std::ranges::all_of(cells, is_unit);
        from = k;
    }
    if (from > 0 && from < block.first && block.separator != ' ' && repeats_headers(headers)) {
        const Cells names = cells_of_line(lines[from - 1], block.separator);
        if (filled(names) >= 2 && names.size() <= block.width && names.front().empty()) {
            add_names(names, headers);
            return from - 1;
        }
        for (std::size_t k = from; k-- > 0;) {  // "Sample Name,S1,S2" at the top of a report
            Cells above = cells_of_line(lines[k], block.separator);
            const std::string word = plain_words(above.front());
            const bool samples = word.starts_with("sample") || word.starts_with("probe") || word.starts_with("record");
            if (!samples || filled(above) < 2 || above.size() > block.width) continue;
            above.front().clear();
            add_names(above, headers);
            break;
        }
    }
    return from;
}

}  // namespace grainsweep::campaign::export_blocks
