// Which column of an export holds sizes and which shares, by the words of their headers.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace grainsweep::campaign {
namespace {

bool has_any(std::string_view text, std::span<const std::string_view> words) {
    return std::ranges::any_of(words, [&](auto word) { return text.find(word) != std::string_view::npos; });
}

constexpr auto passing_words = std::to_array<std::string_view>(
    {"passing", "pass", "undersize", "under", "finer", "durchgang", "less than", "below", "tamisat"});
constexpr auto retained_words = std::to_array<std::string_view>(
    {"retained", "oversize", "over", "coarser", "rueckstand", "greater than", "above", "refus"});
constexpr auto sum_words = std::to_array<std::string_view>({"cum", "kum", "summe", "sum ", "total"});
constexpr auto each_words = std::to_array<std::string_view>({"chan", "frequency", "haeufigkeit", "differential", "each",
                                                             "class", "interval", " in ", "volume in", "p3", "dq3"});
constexpr auto share_words =
    std::to_array<std::string_view>({"%", "volum", "number", "anzahl", "mass", "masse", "weight", "gew", "share",
                                     "anteil", "fraction", "percent", "vol"});
constexpr auto size_words = std::to_array<std::string_view>(
    {"size", "diam", "durchm", "partikel", "groesse", "korn", "aperture", "opening", "maschen", "sieve", "sieb",
     "lower", "upper", "untere", "obere", "klasse", "bin", "x_", "tamis"});
constexpr auto volume_words = std::to_array<std::string_view>(
    {"volum", "vol.", "vol%", "vol-%", "vol ", "mass", "masse", "weight", "wt", "gew", "sieve", "sieb", "tamis"});
constexpr auto number_words = std::to_array<std::string_view>({"number", "anzahl", "count"});
// Of lines around a table: a "serial number" is none.
constexpr auto number_lines = std::to_array<std::string_view>(
    {"by number", "number distribution", "number based", "number-based", "number weighted", "number-weighted",
     "anzahlverteilung", ": number", ";number", ",number", "\tnumber", "; number"});
constexpr auto sieve_words = std::to_array<std::string_view>({"sieve", "sieb", "mesh", "aperture", "maschen", "tamis"});
constexpr auto unused_words =
    std::to_array<std::string_view>({"densit", "dichte", "/um", "per um", "log", "lg", "d(ln", "error", "std"});

/// "x [µm]" and "Size (um)" -> "um"; empty: none.
std::string length_in(std::string_view header) {
    for (const std::string_view unit : {"um", "micron", "mm", "nm"})
        for (const auto& form : {fmt::format("({}", unit), fmt::format("[{}", unit), fmt::format(" {}", unit),
                                 fmt::format("/{}", unit), fmt::format("_{}", unit)}) {
            const auto at = header.find(form);
            if (at == std::string_view::npos) continue;
            const auto behind = header.substr(at + form.size());
            if (behind.empty() || std::string_view(" )],;_s").find(behind.front()) != std::string_view::npos)
                return unit == "micron" ? "um" : std::string(unit);
        }
    return header == "um" || header == "mm" || header == "nm" ? std::string(header) : std::string();
}

/// The reading of a header.
struct Heading {
    std::string plain;
    bool share = false, size = false, unused = false;
    std::optional<std::string> as;
};

Heading heading_of(const std::string& header) {
    Heading heading;
    heading.plain = plain_words(header);
    const auto& plain = heading.plain;
    // Q3 is the sum of q3, which is a density: the letter's case decides. Q0 and q0 likewise by number.
    const bool sum_symbol = header.find("Q3") != std::string::npos || header.find("Q0") != std::string::npos;
    const bool density_symbol = header.find("q3") != std::string::npos || header.find("q0") != std::string::npos;
    const bool step_symbol = plain.find("p3") != std::string::npos || plain.find("dq3") != std::string::npos ||
                             header.find("\xCE\x94Q") != std::string::npos;
    const bool passing = has_any(plain, passing_words), retained = has_any(plain, retained_words);
    const bool sum = has_any(plain, sum_words) || (sum_symbol && !step_symbol);
    const bool each = has_any(plain, each_words) || step_symbol;
    heading.share = passing || retained || sum || step_symbol || density_symbol || has_any(plain, share_words);
    heading.unused = has_any(plain, unused_words) || (density_symbol && !step_symbol && plain.find('%') == plain.npos);
    // "Size classes (um)" and "Particle size, volume (um)" are sizes: a length decides.
    if (!length_in(plain).empty() && plain.find('%') == plain.npos && !heading.unused) heading.share = false;
    heading.size = !heading.share && (has_any(plain, size_words) || !length_in(plain).empty() || plain == "x" ||
                                      plain == "d" || plain.starts_with("x ") || plain.starts_with("d "));
    if (passing)
        heading.as = "passing";
    else if (sum)
        heading.as = retained ? "retained" : "sum";
    else if (each && !retained)
        heading.as = "each";
    return heading;
}

std::string column_list(const ExportGrid& grid, const std::vector<std::size_t>& columns) {
    std::string list;
    for (const auto column : columns)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", column + 1,
                            grid.headers[column].empty() ? "(no header)" : "'" + grid.headers[column] + "'");
    return list;
}

/// A column by its number from 1, or by its header.
std::size_t chosen_column(const ExportGrid& grid, std::string_view option, const std::string& word) {
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < grid.headers.size(); ++j) {
        all.push_back(j);
        if (grid.headers[j] == word || std::to_string(j + 1) == word) return j;
    }
    throw input_error(option, word, fmt::format("must be a column of the table: {}", column_list(grid, all)));
}

bool is_filled(const ExportGrid& grid, std::size_t column) {
    return std::ranges::any_of(
        grid.rows, [&](const auto& row) { return export_size(row[column], grid.decimal_comma).has_value(); });
}

std::size_t size_column(const ExportGrid& grid, const std::vector<Heading>& headings, const ExportChoices& choices,
                        std::optional<std::size_t>& upper) {
    if (choices.sizes) return chosen_column(grid, "--sizes", *choices.sizes);
    std::vector<std::size_t> sizes;
    for (std::size_t j = 0; j < headings.size(); ++j)
        if (headings[j].size && is_filled(grid, j)) sizes.push_back(j);
    if (sizes.size() == 1) return sizes.front();
    const auto says = [&](std::size_t column, std::span<const std::string_view> words) {
        return has_any(headings[column].plain, words);
    };
    constexpr auto low = std::to_array<std::string_view>({"lower", "untere", "from", "von"});
    constexpr auto high = std::to_array<std::string_view>({"upper", "obere", " to", "bis"});
    if (sizes.size() == 2 && says(sizes[0], low) && says(sizes[1], high)) {
        upper = sizes[1];
        return sizes[0];
    }
    const bool unnamed = std::ranges::all_of(grid.headers, [](const auto& header) { return header.empty(); });
    if (sizes.empty() && unnamed && grid.headers.size() == 2) return 0;
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < grid.headers.size(); ++j) all.push_back(j);
    throw input_error("EXPORT", "",
                      fmt::format("which column holds the sizes is not clear: state it by --sizes, of {}",
                                  column_list(grid, sizes.empty() ? all : sizes)));
}

std::size_t share_column(const ExportGrid& grid, const std::vector<Heading>& headings, const ExportChoices& choices,
                         const ExportColumns& found) {
    if (choices.shares) return chosen_column(grid, "--shares", *choices.shares);
    std::vector<std::size_t> shares, unused;
    for (std::size_t j = 0; j < headings.size(); ++j) {
        if (j == found.size || j == found.upper || !is_filled(grid, j)) continue;
        if (headings[j].unused)
            unused.push_back(j);
        else if (headings[j].share || grid.headers[j].empty())
            shares.push_back(j);
    }
    // A cumulative column needs no edges of classes: it is taken before others.
    for (const char* kind : {"passing", "sum", "retained"}) {
        std::vector<std::size_t> of_kind;
        for (const auto j : shares)
            if (headings[j].as == kind) of_kind.push_back(j);
        if (of_kind.size() == 1) return of_kind.front();
        if (of_kind.size() > 1) shares = of_kind;
        if (!of_kind.empty()) break;
    }
    if (shares.size() == 1) return shares.front();
    if (shares.empty() && !unused.empty())
        throw input_error("EXPORT", "",
                          fmt::format("{} is a density, and neither a share nor a sum; export the cumulative shares",
                                      column_list(grid, unused)));
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < grid.headers.size(); ++j)
        if (j != found.size && is_filled(grid, j)) all.push_back(j);
    throw input_error("EXPORT", "",
                      fmt::format("which column holds the shares is not clear: state it by --shares, of {}",
                                  column_list(grid, shares.empty() ? all : shares)));
}

void find_unit(const ExportGrid& grid, const ExportChoices& choices, ExportColumns& columns) {
    if (choices.unit) {
        columns.unit = *choices.unit, columns.unit_from = "--unit";
        return;
    }
    if (const auto unit = length_in(plain_words(grid.headers[columns.size])); !unit.empty()) {
        columns.unit = unit, columns.unit_from = "its header";
        return;
    }
    for (const auto& row : grid.rows)
        if (const auto size = export_size(row[columns.size], grid.decimal_comma);
            size && !size->unit.empty() && size->unit != "%") {
            columns.unit = size->unit.starts_with("micron") ? "um" : size->unit, columns.unit_from = "its cells";
            return;
        }
    std::vector<std::string> named;
    for (const std::string_view unit : {"um", "mm", "nm"})
        for (const std::string_view before : {" ", ":", ";", ",", "\t", "(", "["})
            for (const std::string_view behind : {"\n", " ", ";", ",", "\t", ")", "]"})
                if (grid.around.find(fmt::format("{}{}{}", before, unit, behind)) != std::string::npos &&
                    (named.empty() || named.back() != unit))
                    named.emplace_back(unit);
    if (named.size() == 1) {
        columns.unit = named.front(), columns.unit_from = "the lines around the table";
        return;
    }
    throw input_error(
        "EXPORT", "",
        fmt::format("the unit of the sizes in column {} is not stated: give it by --unit, as in --unit um",
                    columns.size + 1));
}

/// By volume or number, from the column itself, then from the lines around the table.
std::optional<std::string> basis_of(const ExportGrid& grid, const ExportColumns& columns) {
    const std::string& header = grid.headers[columns.share];
    if (header.find("Q0") != std::string::npos) return "number";
    if (header.find("Q3") != std::string::npos) return "volume";
    for (const auto column : {columns.share, columns.size}) {
        const std::string plain = plain_words(grid.headers[column]);
        const bool by_number = has_any(plain, number_words), by_volume = has_any(plain, volume_words);
        if (by_number != by_volume) return by_number ? "number" : "volume";
        if (by_number) return std::nullopt;
    }
    const bool by_number = has_any(grid.around, number_lines), by_volume = has_any(grid.around, volume_words);
    if (by_number == by_volume) return std::nullopt;
    return by_number ? "number" : "volume";
}

}  // namespace

ExportColumns export_columns(const ExportGrid& grid, const ExportChoices& choices) {
    std::vector<Heading> headings;
    for (const auto& header : grid.headers) headings.push_back(heading_of(header));
    ExportColumns columns;
    columns.size = size_column(grid, headings, choices, columns.upper);
    columns.share = share_column(grid, headings, choices, columns);
    if (columns.size == columns.share)
        throw input_error("--shares", grid.headers[columns.share], "is the column of the sizes");
    find_unit(grid, choices, columns);
    const auto& heading = headings[columns.share];
    columns.as = heading.as;
    columns.by = basis_of(grid, columns);
    columns.share_name = column_list(grid, {columns.share});
    const std::string size_header = headings[columns.size].plain;
    columns.percent =
        heading.plain.find('%') != std::string::npos || heading.plain.find("percent") != std::string::npos;
    constexpr auto weights = std::to_array<std::string_view>({"(g)", "[g]", "(kg)", "[kg]", " g", "(mg)", "count"});
    columns.weighed = !columns.percent && (has_any(heading.plain, weights) || heading.plain.ends_with("_g"));
    columns.sieved = has_any(size_header, sieve_words) || has_any(grid.around, sieve_words) || columns.weighed;
    return columns;
}

}  // namespace grainsweep::campaign
