// From the bytes of an export to rows of cells: encoding, separator, decimal sign, the block of numbers.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace grainsweep::campaign {
namespace {

using Lines = std::vector<std::string>;
using Cells = std::vector<std::string>;

constexpr std::size_t longest_line = 16U << 10U;
constexpr std::size_t most_headers = 3;  // lines above a block that may name its columns

void append_utf8(std::string& text, std::uint32_t point) {
    const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    if (point < 0x80U) return byte(point);
    if (point < 0x800U) return byte(0xC0U | point >> 6U), byte(0x80U | (point & 0x3FU));
    if (point < 0x10000U) {
        byte(0xE0U | point >> 12U), byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU));
        return;
    }
    byte(0xF0U | point >> 18U), byte(0x80U | (point >> 12U & 0x3FU));
    byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU));
}

bool is_utf8(std::string_view text) {
    for (std::size_t k = 0; k < text.size();) {
        const auto lead = static_cast<unsigned char>(text[k]);
        const std::size_t length = lead < 0x80U            ? 1
                                   : (lead >> 5U) == 0x6U  ? 2
                                   : (lead >> 4U) == 0xEU  ? 3
                                   : (lead >> 3U) == 0x1EU ? 4
                                                           : 0;
        if (length == 0 || k + length > text.size()) return false;
        for (std::size_t j = 1; j < length; ++j)
            if ((static_cast<unsigned char>(text[k + j]) >> 6U) != 0x2U) return false;
        k += length;
    }
    return true;
}

std::string from_utf16(std::string_view bytes, bool little) {
    std::string text;
    std::uint32_t high = 0;
    for (std::size_t k = 0; k + 1 < bytes.size(); k += 2) {
        const auto first = static_cast<unsigned char>(bytes[k]), second = static_cast<unsigned char>(bytes[k + 1]);
        const std::uint32_t unit = little ? second * 256U + first : first * 256U + second;
        if (unit >= 0xD800U && unit < 0xDC00U) {
            high = unit;
        } else {
            const bool low = unit >= 0xDC00U && unit < 0xE000U;
            append_utf8(text, low ? 0x10000U + ((high & 0x3FFU) << 10U) + (unit & 0x3FFU) : unit);
        }
    }
    return text;
}

/// Returns the text in UTF-8, and its original encoding.
std::pair<std::string, std::string> decoded(std::string_view bytes) {
    if (bytes.starts_with("\xFF\xFE")) return {from_utf16(bytes.substr(2), true), "UTF-16"};
    if (bytes.starts_with("\xFE\xFF")) return {from_utf16(bytes.substr(2), false), "UTF-16"};
    if (bytes.starts_with("\xEF\xBB\xBF")) return {std::string(bytes.substr(3)), "UTF-8 with a byte order mark"};
    if (is_utf8(bytes)) return {std::string(bytes), "UTF-8"};
    std::string text;
    for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
    return {text, "Latin-1"};
}

Lines text_lines(const std::string& text) {
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

Cells plain_cells(std::string_view line, char separator) {
    Cells cells;
    for (auto end = line.find(separator); end != std::string_view::npos; end = line.find(separator)) {
        if (separator != ' ' || end > 0) cells.emplace_back(line.substr(0, end));
        line.remove_prefix(end + 1);
    }
    cells.emplace_back(line);
    return cells;
}

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

/// Cells of a line; a blank as separator stands for any number of blanks. A line that is longer than any of an export
/// has none.
Cells cells_of_line(std::string_view line, char separator) {
    if (line.size() > longest_line) return {};
    if (separator == ' ') line = trimmed(line);
    Cells cells =
        line.find('"') == std::string_view::npos ? plain_cells(line, separator) : quoted_cells(line, separator);
    for (auto& cell : cells) cell = std::string(trimmed(cell));
    while (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
}

bool is_gap(const std::string& cell) {
    return cell.empty() || cell == "-" || cell == "--" || plain_words(cell) == "n/a";
}

/// Whether cells are a row of a table: two or more numbers, and nothing else but gaps, sizes and one name in front.
bool is_row(const Cells& cells, bool decimal_comma) {
    std::size_t numbers = 0, names = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        if (is_gap(cells[k])) continue;
        if (export_number(cells[k], decimal_comma) || (k < 2 && export_size(cells[k], decimal_comma)))
            ++numbers;
        else if (k == 0)
            ++names;
        else
            return false;
    }
    return numbers >= 2 && numbers > names;
}

struct Block {
    char separator = ',';
    bool decimal_comma = false;
    std::size_t first = 0, rows = 0, width = 0, numbers = 0;
};

/// The longest run of rows under one reading of the text.
Block longest_block(const Lines& lines, char separator, bool decimal_comma) {
    Block best{separator, decimal_comma}, run{separator, decimal_comma};
    for (std::size_t k = 0; k <= lines.size(); ++k) {
        const Cells cells = k < lines.size() ? cells_of_line(lines[k], separator) : Cells{};
        const bool row = k < lines.size() && is_row(cells, decimal_comma);
        if (!row) {
            if (run.numbers > best.numbers) best = run;
            run = {separator, decimal_comma, k + 1};
            continue;
        }
        ++run.rows;
        run.width = std::max(run.width, cells.size());
        for (const auto& cell : cells)
            if (export_number(cell, decimal_comma)) ++run.numbers;
    }
    return best;
}

Block block_of(const Lines& lines) {
    constexpr std::array<std::pair<char, bool>, 8> readings = {
        {{'\t', false}, {'\t', true}, {';', false}, {';', true}, {',', false}, {' ', false}, {' ', true}, {',', true}}};
    Block best;
    for (const auto& [separator, decimal_comma] : readings) {
        const Block block = longest_block(lines, separator, decimal_comma);
        if (block.numbers > best.numbers) best = block;
    }
    if (best.rows < 2)
        throw input_error("EXPORT", "", "no table of sizes and shares is in it: two or more lines of numbers");
    return best;
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
        {"", "-", "1", "um", "mm", "nm", "m", "micron", "%", "vol.-%", "vol%", "g", "kg", "mg", "%/um", "1/um"});
    std::string plain = plain_words(cell);
    std::erase_if(plain, [](char c) { return std::string_view("()[] ").find(c) != std::string_view::npos; });
    return std::ranges::find(units, plain) != units.end();
}

/// Names of the columns from the lines directly above the block, the names' own and the units' below them; returns the
/// first of these lines.
std::size_t read_headers(const Lines& lines, const Block& block, std::vector<std::string>& headers) {
    headers.assign(block.width, {});
    std::size_t from = block.first;
    bool units_only = true;
    for (std::size_t k = block.first; k-- > 0 && block.first - k <= most_headers && units_only;) {
        std::string line = lines[k];
        line.erase(0, line.find_first_not_of("# \t"));  // of a comment
        if (from == block.first && line.empty()) continue;
        const Cells cells = header_cells(line, block);
        const auto filled = std::ranges::count_if(cells, [](const auto& cell) { return !cell.empty(); });
        if (filled < 2 || cells.size() > block.width || is_row(cells, block.decimal_comma)) break;
        for (std::size_t j = 0; j < cells.size(); ++j)
            if (!cells[j].empty()) headers[j] = cells[j] + (headers[j].empty() ? "" : " " + headers[j]);
        units_only = std::ranges::all_of(cells, is_unit);
        from = k;
    }
    return from;
}

/// "size, share, size, share, ...": groups with the same headers become rows.
ExportGrid unrolled(ExportGrid grid) {
    const std::size_t width = grid.headers.size();
    for (std::size_t group = 2; group <= width / 2; ++group) {
        if (width % group != 0 || grid.headers[0].empty()) continue;
        bool repeats = true;
        for (std::size_t j = group; j < width; ++j) repeats = repeats && grid.headers[j] == grid.headers[j % group];
        if (!repeats) continue;
        std::vector<std::vector<std::string>> rows;
        for (std::size_t first = 0; first < width; first += group)
            for (const auto& row : grid.rows)
                if (!row[first].empty())
                    rows.emplace_back(row.begin() + static_cast<std::ptrdiff_t>(first),
                                      row.begin() + static_cast<std::ptrdiff_t>(first + group));
        grid.rows = std::move(rows);
        grid.headers.resize(group);
        break;
    }
    return grid;
}

}  // namespace

std::string plain_words(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 9> letters = {{{"\xC2\xB5", "u"},
                                                                                       {"\xCE\xBC", "u"},
                                                                                       {"\xC3\xA4", "ae"},
                                                                                       {"\xC3\xB6", "oe"},
                                                                                       {"\xC3\xBC", "ue"},
                                                                                       {"\xC3\x9C", "ue"},
                                                                                       {"\xC3\x9F", "ss"},
                                                                                       {"\xE2\x89\xA4", "<"},
                                                                                       {"\xE2\x80\x93", "-"}}};
    std::string plain;
    while (!text.empty()) {
        const auto found = std::ranges::find_if(letters, [&](const auto& one) { return text.starts_with(one.first); });
        if (found != letters.end()) {
            plain += found->second;
            text.remove_prefix(found->first.size());
        } else {
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
            text.remove_prefix(1);
        }
    }
    return plain;
}

std::optional<ExportNumber> export_number(std::string_view cell, bool decimal_comma) {
    std::string text = plain_words(trimmed(cell));
    const auto end = std::min(text.find_first_not_of("0123456789.,+-e"), text.size());
    std::string digits = text.substr(0, end);
    if (digits.ends_with('e')) return std::nullopt;
    const char foreign = decimal_comma ? '.' : ',';
    if (digits.empty() || digits.find(foreign) != std::string::npos) return std::nullopt;
    std::ranges::replace(digits, ',', '.');
    if (digits.starts_with('+')) digits.erase(0, 1);
    const auto number = number_in(digits);
    if (!number) return std::nullopt;
    const std::string unit(trimmed(std::string_view(text).substr(end)));
    constexpr std::array<std::string_view, 10> units = {"", "%", "um", "mm", "nm", "m", "micron", "microns", "g", "kg"};
    if (std::ranges::find(units, unit) == units.end()) return std::nullopt;
    return ExportNumber{*number, unit};
}

std::optional<ExportSize> export_size(std::string_view cell, bool decimal_comma) {
    using Kind = ExportSize::Kind;
    const std::string text = plain_words(trimmed(cell));
    constexpr std::array<std::string_view, 8> pans = {"pan",   "base", "bottom", "receiver",
                                                      "boden", "tray", "fond",   "bottom pan"};
    if (std::ranges::find(pans, text) != pans.end()) return ExportSize{Kind::pan, 0, 0, {}};
    if (const auto number = export_number(text, decimal_comma))
        return ExportSize{Kind::point, number->value, number->value, number->unit};
    const auto part = [&](std::string_view word) { return export_number(word, decimal_comma); };
    if (text.starts_with('<') || text.starts_with('>')) {
        const auto number =
            part(std::string_view(text).substr(text.starts_with("<=") || text.starts_with(">=") ? 2 : 1));
        if (!number) return std::nullopt;
        return ExportSize{text.front() == '<' ? Kind::below : Kind::above, number->value, number->value, number->unit};
    }
    for (std::size_t dash = text.find('-', 1); dash != std::string::npos; dash = text.find('-', dash + 1)) {
        const auto low = part(std::string_view(text).substr(0, dash));
        const auto high = part(std::string_view(text).substr(dash + 1));
        if (low && high && low->value < high->value)
            return ExportSize{Kind::range, low->value, high->value, high->unit};
    }
    return std::nullopt;
}

ExportGrid export_grid(std::string_view bytes) {
    const auto [text, encoding] = decoded(bytes);
    const Lines lines = text_lines(text);
    const Block block = block_of(lines);
    ExportGrid grid{encoding, block.separator, block.decimal_comma, block.first + 1, block.first + block.rows, {}, {},
                    {}};
    for (std::size_t k = 0; k < block.rows; ++k) {
        grid.rows.push_back(cells_of_line(lines[block.first + k], block.separator));
        grid.rows.back().resize(block.width);
    }
    const std::size_t headers = read_headers(lines, block, grid.headers);
    for (std::size_t k = 0; k < lines.size(); ++k)
        if (k < headers || k >= block.first + block.rows) grid.around += plain_words(lines[k]) + "\n";
    return unrolled(std::move(grid));
}

}  // namespace grainsweep::campaign
