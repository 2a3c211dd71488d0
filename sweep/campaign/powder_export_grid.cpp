// Chooses the table of an export: of several blocks, sheets and samples, upright or lying.
#include "sweep/campaign/powder_export_blocks.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace grainsweep::campaign {
namespace {

using export_blocks::Block;
using export_blocks::Cells;
using export_blocks::Lines;

constexpr std::size_t shortest_lying = 4;  // numbers of a line that may be a lying column
constexpr std::size_t far_longer = 3;      // a table with so many times the rows of the others is the one

bool is_empty_column(const ExportGrid& grid, std::size_t column) {
    return std::ranges::all_of(grid.rows, [&](const auto& row) { return row[column].empty(); });
}

/// Whether a column counts its rows: 1, 2, 3, ... or from 0.
bool counts_rows(const ExportGrid& grid, std::size_t column) {
    const auto first = number_at(grid, 0, column);
    if (!first || (*first != 0 && *first != 1)) return false;
    for (std::size_t k = 1; k < grid.rows.size(); ++k)
        if (number_at(grid, k, column) != *first + static_cast<double>(k)) return false;
    return grid.rows.size() > 2;
}

/// Puts headers above their numbers where a tabulator or a column without a name shifted them.
void align_headers(ExportGrid& grid) {
    std::vector<std::size_t> named, numbers;
    bool apart = false;
    for (std::size_t j = 0; j < grid.headers.size(); ++j) {
        const bool empty = is_empty_column(grid, j);
        if (!grid.headers[j].empty()) named.push_back(j);
        if (!empty) numbers.push_back(j);
        apart = apart || (empty && !grid.headers[j].empty());
    }
    if (named.empty()) return;
    if (apart && named.size() == numbers.size()) {
        std::vector<std::string> headers(grid.headers.size());
        for (std::size_t k = 0; k < named.size(); ++k) headers[numbers[k]] = grid.headers[named[k]];
        grid.headers = std::move(headers);
        grid.notes.emplace_back("the names of the columns stand beside their numbers and are taken in their order");
    } else if (named.size() + 1 == numbers.size() && numbers.size() > 2 && named.back() + 1 == numbers.back() &&
               grid.headers.back().empty() && counts_rows(grid, numbers.front())) {
        for (std::size_t j = grid.headers.size() - 1; j > 0; --j) grid.headers[j] = grid.headers[j - 1];
        grid.headers[numbers.front()].clear();
        grid.notes.emplace_back("the first column counts the rows; the names stand above the columns behind it");
    }
}

void drop_empty_columns(ExportGrid& grid) {
    for (std::size_t j = grid.headers.size(); j-- > 0;) {
        if (!is_empty_column(grid, j)) continue;
        const auto at = static_cast<std::ptrdiff_t>(j);
        grid.headers.erase(grid.headers.begin() + at);
        grid.numbers.erase(grid.numbers.begin() + at);
        for (auto& row : grid.rows) row.erase(row.begin() + at);
    }
}

/// "size, share, size, share, ...": groups with the same headers and further sizes become rows.
void unroll(ExportGrid& grid) {
    const std::size_t width = grid.headers.size();
    for (std::size_t group = 2; group <= width / 2; ++group) {
        if (width % group != 0 || grid.headers[0].empty()) continue;
        bool repeats = true;
        for (std::size_t j = group; j < width; ++j) repeats = repeats && grid.headers[j] == grid.headers[j % group];
        if (!repeats) continue;
        std::vector<std::vector<std::string>> rows;
        std::vector<std::size_t> lines;
        std::set<std::string> sizes;
        for (std::size_t first = 0; first < width; first += group)
            for (std::size_t k = 0; k < grid.rows.size(); ++k) {
                const auto& row = grid.rows[k];
                if (row[first].empty()) continue;
                if (!sizes.insert(row[first]).second) return;  // several samples
                rows.emplace_back(row.begin() + static_cast<std::ptrdiff_t>(first),
                                  row.begin() + static_cast<std::ptrdiff_t>(first + group));
                lines.push_back(grid.lines[k]);
            }
        grid.rows = std::move(rows);
        grid.lines = std::move(lines);
        grid.headers.resize(group);
        grid.numbers.resize(group);
        return;
    }
}

/// Lines with a name in front, the first of sizes: their numbers are columns.
bool is_lying(const ExportGrid& grid) {
    if (grid.headers.size() < shortest_lying + 1 || !export_heading(grid.rows[0][0]).size) return false;
    double before = 0;
    for (std::size_t j = 1; j < grid.headers.size(); ++j) {
        if (grid.rows[0][j].empty()) continue;
        const auto size = number_at(grid, 0, j);
        if (!size || !(*size > before)) return false;
        before = *size;
    }
    return std::ranges::all_of(
        grid.rows, [&](const auto& row) { return !row[0].empty() && !export_size(row[0], grid.decimal_comma); });
}

void set_upright(ExportGrid& grid) {
    ExportGrid upright = grid;
    upright.headers.clear(), upright.rows.clear(), upright.lines.clear();
    for (const auto& row : grid.rows) upright.headers.push_back(row[0]);
    for (std::size_t j = 1; j < grid.headers.size(); ++j) {
        upright.rows.emplace_back();
        for (const auto& row : grid.rows) upright.rows.back().push_back(row[j]);
        upright.lines.push_back(grid.lines.front());
    }
    grid = std::move(upright);
}

/// A block with the line from which its headers stand.
struct ExportTable {
    ExportGrid grid;
    std::size_t head = 0, end = 0;  ///< lines, from 0; end: behind it
    std::size_t text = 0;           ///< of the export
    std::string broken;             ///< why a row of it is missing; empty: none is

    [[nodiscard]] std::string place() const {
        return fmt::format("{}lines {} to {}", grid.sheet.empty() ? "" : "sheet '" + grid.sheet + "', ", head + 1, end);
    }
};

ExportTable table_of(const Lines& lines, const Block& block, const ExportText& text) {
    ExportTable table;
    table.grid.encoding = text.encoding, table.grid.sheet = text.sheet;
    table.grid.separator = block.separator, table.grid.decimal_comma = block.decimal_comma;
    table.head = block.first, table.end = block.first + block.rows;
    auto& grid = table.grid;
    for (std::size_t k = 0; k < block.rows; ++k) {
        grid.rows.push_back(export_blocks::cells_of_line(lines[block.first + k], block.separator));
        grid.rows.back().resize(block.width);
        grid.lines.push_back(block.first + k + 1);
    }
    grid.headers.resize(block.width);
    if (is_lying(grid))
        set_upright(grid);
    else
        table.head = export_blocks::read_headers(lines, block, grid.headers);
    for (std::size_t j = 0; j < grid.headers.size(); ++j) grid.numbers.push_back(j + 1);
    align_headers(grid);
    drop_empty_columns(grid);
    unroll(grid);
    return table;
}

/// Continues a table that an empty line or a page with the same headers broke.
bool continues(const ExportTable& table, const ExportTable& next) {
    const auto& a = table.grid;
    const auto& b = next.grid;
    if (a.headers.size() != b.headers.size()) return false;
    const bool unnamed = std::ranges::all_of(b.headers, [](const auto& header) { return header.empty(); });
    if (!unnamed && b.headers != a.headers) return false;
    std::size_t column = 0;
    while (column + 1 < a.headers.size() && !export_heading(a.headers[column]).size) ++column;
    if (!export_heading(a.headers[column]).size) column = 0;
    const auto first = number_at(a, 0, column), last = number_at(a, a.rows.size() - 1, column),
               then = number_at(b, 0, column);
    return first && last && then && *first != *last && (*last > *first ? *then > *last : *then < *last);
}

bool is_size_table(const ExportGrid& grid) {
    bool size = false, share = false, percentile = false, named = false;
    for (const auto& header : grid.headers) {
        const auto heading = export_heading(header);
        named = named || !header.empty();
        size = size || heading.size;
        percentile = percentile || heading.percentile;
        share = share || heading.share || heading.density || header.empty();
    }
    return !percentile && ((size && share) || (!named && grid.headers.size() == 2));
}

/// The reading of a text with the most numbers in one block.
std::vector<Block> best_blocks(const Lines& lines, const std::string& text) {
    constexpr std::array<std::pair<char, bool>, 10> readings = {{{'\t', false},
                                                                 {'\t', true},
                                                                 {';', false},
                                                                 {';', true},
                                                                 {',', false},
                                                                 {' ', false},
                                                                 {' ', true},
                                                                 {',', true},
                                                                 {'|', false},
                                                                 {'|', true}}};
    std::vector<Block> best;
    std::size_t most = 0;
    const bool commas = text.find(',') != std::string::npos, quotes = text.find('"') != std::string::npos;
    for (const auto& [separator, decimal_comma] : readings) {
        if (text.find(separator) == std::string::npos || (decimal_comma && !commas)) continue;
        if (decimal_comma && separator == ',' && !quotes) continue;
        auto blocks = export_blocks::blocks_of(lines, separator, decimal_comma);
        for (const auto& block : blocks)
            if (block.numbers > most) {
                most = block.numbers;
                best = blocks;
            }
    }
    return best;
}

/// Lines around a table, without its own: all of them, or of several tables those that lead to it.
void add_surroundings(ExportTable& table, const Lines& lines, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
        if (k < table.head || k >= table.end) {
            table.grid.around.push_back(plain_words(lines[k]));
            table.grid.words += table.grid.around.back() + "\n";
        }
}

/// One line of sizes behind several cells of words, and lines of records below it.
std::optional<ExportTable> records_of(const Lines& lines, const ExportText& text) {
    constexpr std::size_t fewest = 8;
    for (const auto& [separator, comma] :
         {std::pair{'\t', false}, {'\t', true}, {';', false}, {';', true}, {',', false}})
        for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
            const Cells head = export_blocks::cells_of_line(lines[k], separator);
            std::size_t begin = head.size();
            double behind = HUGE_VAL;
            while (begin > 0) {
                const auto size = export_number(head[begin - 1], comma);
                if (!size || !(size->value < behind) || !(size->value >= 0)) break;
                behind = size->value, --begin;
            }
            if (begin == 0 || head.size() - begin < fewest) continue;
            ExportTable table;
            table.grid.encoding = text.encoding, table.grid.sheet = text.sheet, table.grid.headers = {"Size"};
            table.grid.separator = separator, table.grid.decimal_comma = comma;
            table.head = k, table.end = k + 1;
            auto& grid = table.grid;
            for (std::size_t j = begin; j < head.size(); ++j)
                grid.rows.push_back({head[j]}), grid.lines.push_back(k + 1);
            const auto is_number = [&](const auto& cell) { return export_number(cell, comma).has_value(); };
            while (table.end < lines.size()) {
                const Cells record = export_blocks::cells_of_line(lines[table.end], separator);
                if (record.size() != head.size() ||
                    !std::all_of(record.begin() + static_cast<std::ptrdiff_t>(begin), record.end(), is_number))
                    break;
                grid.headers.push_back(record[0].empty() ? fmt::format("shares of line {}", table.end + 1)
                                                         : "shares of " + record[0]);
                for (std::size_t j = begin; j < head.size(); ++j) grid.rows[j - begin].push_back(record[j]);
                ++table.end;
            }
            if (grid.headers.size() < 2) continue;
            for (std::size_t j = 0; j < grid.headers.size(); ++j) grid.numbers.push_back(j + 1);
            for (std::size_t line = k; line < (grid.headers.size() == 2 ? k + 2 : k + 1); ++line) {
                const Cells cells = export_blocks::cells_of_line(lines[line], separator);
                std::string words;
                for (std::size_t j = 0; j < begin; ++j) words += plain_words(cells[j]) + separator;
                grid.around.push_back(words), grid.words += words + "\n";
            }
            return table;
        }
    return std::nullopt;
}

/// Whether a text names a sample: the same words, or as a part of them.
bool names_sample(std::string_view text, const std::string& sample) {
    return plain_words(text).find(plain_words(sample)) != std::string::npos;
}

[[noreturn]] void refuse_sample(const std::optional<std::string>& sample, const std::string& what) {
    throw input_error(sample ? "--sample" : "EXPORT", sample.value_or(""),
                      fmt::format("{}: state which one by --sample, its number or a part of its name", what));
}

/// Of several tables the one that the user names; else the one that is far longer than the others.
ExportTable& chosen_table(std::vector<ExportTable>& tables, const std::optional<std::string>& sample) {
    std::string list;
    for (const auto& table : tables)
        list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", &table - tables.data() + 1, table.place());
    const std::string several = fmt::format("the file has {} tables, {}", tables.size(), list);
    if (sample) {
        std::vector<std::size_t> found;
        for (std::size_t k = 0; k < tables.size(); ++k) {
            const auto& grid = tables[k].grid;
            if (*sample == std::to_string(k + 1)) return tables[k];
            if (names_sample(grid.sheet, *sample) || names_sample(grid.words, *sample)) found.push_back(k);
        }
        if (found.size() == 1) return tables[found.front()];
        refuse_sample(sample, several);
    }
    const auto longest = std::ranges::max_element(tables, {}, [](const auto& table) { return table.grid.rows.size(); });
    std::string left_out;
    for (auto& table : tables) {
        if (&table == &*longest) continue;
        if (table.grid.rows.size() * far_longer > longest->grid.rows.size()) refuse_sample(sample, several);
        left_out += (left_out.empty() ? "" : ", ") + table.place();
    }
    if (!left_out.empty()) longest->grid.notes.push_back(fmt::format("shorter tables are left out: {}", left_out));
    return *longest;
}

/// Rows of one sample, where a column names the sample of each row.
void keep_sample(ExportGrid& grid, const std::optional<std::string>& sample) {
    constexpr auto words = std::to_array<std::string_view>(
        {"sample", "probe", "echantillon", "muestra", "campione", "lot", "charge", "batch", "material", "name", "id"});
    for (std::size_t j = 0; j < grid.headers.size(); ++j) {
        const std::string plain = plain_words(grid.headers[j]);
        const auto heading = export_heading(grid.headers[j]);
        const bool text = std::ranges::all_of(
            grid.rows, [&](const auto& row) { return !row[j].empty() && !export_size(row[j], grid.decimal_comma); });
        const bool named = !heading.size && !heading.share &&
                           std::ranges::any_of(words, [&](auto word) { return plain.starts_with(word); });
        if (!text && !named) continue;
        std::vector<std::string> names;
        for (const auto& row : grid.rows)
            if (std::ranges::find(names, row[j]) == names.end()) names.push_back(row[j]);
        if (names.size() < 2 || names.size() * 2 > grid.rows.size()) continue;
        std::vector<std::string> found;
        if (sample)
            for (std::size_t k = 0; k < names.size(); ++k)
                if (plain_words(names[k]) == plain_words(*sample)) found = {names[k]};
        if (sample && found.empty())
            for (const auto& name : names)
                if (names_sample(name, *sample)) found.push_back(name);
        if (found.size() != 1)
            refuse_sample(sample, fmt::format("the file has {} samples, {}", names.size(), listed(names)));
        ExportGrid kept = grid;
        kept.rows.clear(), kept.lines.clear();
        for (std::size_t k = 0; k < grid.rows.size(); ++k)
            if (grid.rows[k][j] == found.front())
                kept.rows.push_back(grid.rows[k]), kept.lines.push_back(grid.lines[k]);
        kept.notes.push_back(fmt::format("of {} samples '{}' is taken", names.size(), found.front()));
        kept.sample_chosen = true;
        grid = std::move(kept);
        return;
    }
}

/// The one cell of a line of numbers that is none; empty: there is no such cell, or the line is another one.
std::optional<std::string> odd_cell(const Lines& lines, std::size_t line, const Block& block, bool amid_rows) {
    if (line >= lines.size()) return std::nullopt;
    const Cells cells = export_blocks::cells_of_line(lines[line], block.separator);
    if (cells.size() < 2 || cells.size() != block.width) return std::nullopt;
    std::vector<std::string> odd;
    for (const auto& cell : cells)
        if (!export_number(cell, block.decimal_comma) && !export_size(cell, block.decimal_comma)) odd.push_back(cell);
    if (odd.size() != 1) return std::nullopt;
    const bool digits = !odd[0].empty() && std::string_view("0123456789.-+").find(odd[0][0]) != std::string_view::npos;
    return digits || amid_rows ? std::optional(odd[0]) : std::nullopt;
}

/// Why a block lacks a row: a line at its end, or above it, of which one cell is no number. Empty: it lacks none.
std::string broken_row(const Lines& lines, const std::vector<Block>& blocks, const Block& block) {
    const std::size_t end = block.first + block.rows;
    const bool goes_on = std::ranges::any_of(blocks, [&](const Block& next) { return next.first == end + 1; });
    const auto sentence = [](std::size_t line, const std::string& cell) {
        return fmt::format("line {}: '{}' is no number", line + 1, cell);
    };
    if (const auto odd = odd_cell(lines, end, block, goes_on)) return sentence(end, *odd);
    if (block.first == 0) return {};
    const auto odd = odd_cell(lines, block.first - 1, block, false);
    return odd ? sentence(block.first - 1, *odd) : std::string();
}

void append(std::vector<ExportTable>& into, std::vector<ExportTable>&& tables) {
    into.insert(into.end(), std::make_move_iterator(tables.begin()), std::make_move_iterator(tables.end()));
}

/// Tables of one text: those of sizes, and all others.
void collect(const ExportText& text, std::size_t index, std::vector<ExportTable>& sizes,
             std::vector<ExportTable>& others) {
    const Lines lines = export_blocks::lines_of(text.text);
    std::vector<ExportTable> found, rest;
    const auto blocks = best_blocks(lines, text.text);
    for (const auto& block : blocks) {
        ExportTable table = table_of(lines, block, text);
        table.text = index;
        table.broken = broken_row(lines, blocks, block);
        auto& last = found.empty() ? rest : found;
        if (!last.empty() && &last == &found && continues(last.back(), table)) {
            auto& grid = last.back().grid;
            grid.rows.insert(grid.rows.end(), table.grid.rows.begin(), table.grid.rows.end());
            grid.lines.insert(grid.lines.end(), table.grid.lines.begin(), table.grid.lines.end());
            last.back().end = table.end;
            if (last.back().broken.empty()) last.back().broken = std::move(table.broken);
            continue;
        }
        (is_size_table(table.grid) ? found : rest).push_back(std::move(table));
    }
    if (found.empty())
        if (auto records = records_of(lines, text)) found.push_back(std::move(*records));
    for (std::size_t k = 0; k < found.size(); ++k)
        add_surroundings(found[k], lines, k == 0 ? 0 : found[k - 1].end,
                         k + 1 == found.size() ? lines.size() : found[k].end);
    for (auto& table : rest) add_surroundings(table, lines, 0, lines.size());
    append(sizes, std::move(found));
    append(others, std::move(rest));
}

}  // namespace

ExportGrid export_grid(std::string_view bytes, const ExportChoices& choices) {
    std::vector<ExportTable> tables, others;
    const auto texts = export_texts(bytes);
    for (std::size_t k = 0; k < texts.size(); ++k) collect(texts[k], k, tables, others);
    if (tables.empty()) {  // without headers, or percentiles only
        const auto longest =
            std::ranges::max_element(others, {}, [](const auto& table) { return table.grid.rows.size(); });
        if (longest != others.end()) tables.push_back(std::move(*longest));
    }
    if (tables.empty()) refuse_export("no table of sizes and shares is in it: two or more lines of numbers");
    ExportTable& table = tables.size() == 1 ? tables.front() : chosen_table(tables, choices.sample);
    if (!table.broken.empty()) refuse_export(table.broken);
    ExportGrid grid = std::move(table.grid);
    grid.sample_chosen = tables.size() > 1 && choices.sample;
    if (!grid.sample_chosen) keep_sample(grid, choices.sample);
    return grid;
}

}  // namespace grainsweep::campaign
