// Which column of an export holds sizes and which shares.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/sieve_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <ranges>
#include <span>

namespace grainsweep::campaign {
namespace {

constexpr auto around_volume = std::to_array<std::string_view>(
    {"volum", "vol.", "vol%", "vol-%", "mass", "masse", "weight", "wt", "gew", "sieve", "sieb", "tamis", "einwaage"});
// Of lines around a table: a "serial number" is none.
constexpr auto around_number = std::to_array<std::string_view>(
    {"by number", "number distribution", "number based", "number-based", "number weighted", "number-weighted",
     "anzahlverteilung", ": number", ";number", ",number", "\tnumber", "; number"});
constexpr auto sieve_words = std::to_array<std::string_view>(
    {"sieve", "sieb", "mesh", "aperture", "opening", "maschen", "tamis", "tamiz", "setacci"});
constexpr auto lower_edge_words = std::to_array<std::string_view>({"lower", "untere", "retain", "rueckst"});
constexpr auto upper_edge_words =
    std::to_array<std::string_view>({"upper", "obere", "passing", "through", "durchgang"});
using Headings = std::vector<ExportHeading>;

/// A column by its number from 1, by its header, or by a part that no other header has.
std::size_t chosen_column(const ExportGrid& grid, std::string_view option, const std::string& word) {
    std::vector<std::size_t> all, parts;
    for (std::size_t j = 0; j < grid.headers.size(); ++j) {
        all.push_back(j);
        if (grid.headers[j] == word || std::to_string(grid.numbers[j]) == word) return j;
        if (plain_words(grid.headers[j]).find(plain_words(word)) != std::string::npos) parts.push_back(j);
    }
    if (parts.size() == 1) return parts.front();
    throw input_error(option, word,
                      fmt::format("must be {} of the table: {}", parts.empty() ? "a column" : "one column",
                                  column_list(grid, parts.empty() ? all : parts)));
}

bool is_filled(const ExportGrid& grid, std::size_t column) {
    return std::ranges::any_of(grid.rows, [&](const auto& row) {
        return export_number(row[column], grid.decimal_comma) || export_size(row[column], grid.decimal_comma);
    });
}

/// Whether cells are sizes by their signs: classes, units, numbers of sieves, a pan.
bool holds_sizes(const ExportGrid& grid, std::size_t column) {
    std::size_t signs = 0;
    for (const auto& row : grid.rows) {
        const auto size = export_size(row[column], grid.decimal_comma);
        if (!size) return false;
        const bool length = !size->unit.empty() && size->unit != "g" && size->unit != "kg" && size->unit != "mg";
        signs += size->kind != ExportSize::Kind::point || length || size->retained_on ? 1 : 0;
    }
    return signs * 2 >= grid.rows.size() && signs > 0;
}

/// Whether two columns are the edges of classes: each class begins where the one before ends.
bool are_edges(const ExportGrid& grid, std::size_t lower, std::size_t upper) {
    std::size_t joined = 0;
    for (std::size_t k = 0; k < grid.rows.size(); ++k) {
        const auto low = number_at(grid, k, lower), high = number_at(grid, k, upper);
        if (!low || !high || !(*low < *high)) return false;
        if (k == 0) continue;
        const auto before_low = *number_at(grid, k - 1, lower), before_high = *number_at(grid, k - 1, upper);
        const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); };
        joined += same(*low, before_high) || same(*high, before_low) ? 1 : 0;
    }
    return grid.rows.size() > 1 && joined + 1 == grid.rows.size();
}

bool counts_up(const ExportGrid& grid, std::size_t column) {
    for (std::size_t k = 1; k < grid.rows.size(); ++k) {
        const auto before = number_at(grid, k - 1, column), here = number_at(grid, k, column);
        if (!before || !here || *here != *before + 1) return false;
    }
    const auto first = number_at(grid, 0, column);
    return first && *first >= 0 && *first <= 1;
}

/// Columns of sizes; edges of classes and columns with a unit go before others.
std::vector<std::size_t> size_columns(const ExportGrid& grid, const Headings& headings) {
    std::vector<std::size_t> sizes;
    for (std::size_t j = 0; j < headings.size(); ++j)
        if (headings[j].size && !headings[j].ignored && is_filled(grid, j)) sizes.push_back(j);
    for (std::size_t j = 0; sizes.empty() && j < headings.size(); ++j)
        if (holds_sizes(grid, j)) sizes.push_back(j);
    const auto prefer = [&](const auto& wanted) {
        std::vector<std::size_t> some;
        std::ranges::copy_if(sizes, std::back_inserter(some), wanted);
        if (!some.empty()) sizes = std::move(some);
    };
    constexpr auto middles =
        std::to_array<std::string_view>({"mean", "mid", "mittel", "centre", "center", "xm", "moyen", "geom"});
    if (sizes.size() > 1) prefer([&](auto j) { return !counts_up(grid, j); });
    if (sizes.size() > 1) prefer([&](auto j) { return !has_word(headings[j].plain, middles); });
    if (sizes.size() > 1) prefer([&](auto j) { return !headings[j].length.empty() && headings[j].length != "phi"; });
    if (sizes.size() > 1) prefer([&](auto j) { return !headings[j].sieve_number; });
    return sizes;
}

std::optional<std::size_t> upper_of(const ExportGrid& grid, const Headings& headings, std::size_t lower) {
    if (lower + 1 >= headings.size()) return std::nullopt;
    const auto& next = headings[lower + 1];
    if ((grid.headers[lower + 1].empty() || next.size) && are_edges(grid, lower, lower + 1)) return lower + 1;
    return std::nullopt;
}

/// Column of sizes; before a chosen column of shares the nearest to its left.
std::size_t size_column(const ExportGrid& grid, const Headings& headings, const ExportChoices& choices,
                        std::optional<std::size_t>& upper) {
    if (choices.sizes) {
        const auto column = chosen_column(grid, "--sizes", *choices.sizes);
        upper = upper_of(grid, headings, column);
        return column;
    }
    const auto sizes = size_columns(grid, headings);
    if (!sizes.empty()) upper = upper_of(grid, headings, sizes.front());
    if (sizes.size() == 1 || (sizes.size() == 2 && upper == sizes[1])) return sizes.front();
    upper.reset();
    const auto says = [&](std::size_t column, std::span<const std::string_view> words) {
        return has_word(headings[column].plain, words);
    };
    constexpr auto low = std::to_array<std::string_view>({"from", "von", "xu", "min"});
    constexpr auto high = std::to_array<std::string_view>({" to", "bis", "xo", "max"});
    const auto are_lower_and_upper = [&](std::size_t lower, std::size_t above) {
        return (says(lower, lower_edge_words) || says(lower, low)) &&
               (says(above, upper_edge_words) || says(above, high));
    };
    for (const auto& [lower, above] : {std::pair<std::size_t, std::size_t>(0, 1), {1, 0}})
        if (sizes.size() == 2 && are_lower_and_upper(sizes[lower], sizes[above])) {
            upper = sizes[above];
            return sizes[lower];
        }
    if (choices.shares && sizes.size() > 1) {
        const auto share = chosen_column(grid, "--shares", *choices.shares);
        const auto behind = std::ranges::lower_bound(sizes, share);
        if (behind != sizes.begin()) return *(behind - 1);
    }
    const bool unnamed = std::ranges::all_of(grid.headers, [](const auto& header) { return header.empty(); });
    if (sizes.empty() && unnamed && grid.headers.size() == 2) return 0;
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < grid.headers.size(); ++j) all.push_back(j);
    refuse_export(fmt::format("which column holds the sizes is not clear: state it by --sizes, of {}",
                              column_list(grid, sizes.empty() ? all : sizes)));
}

void keep_if_any(std::vector<std::size_t>& columns, const auto& wanted) {
    std::vector<std::size_t> some;
    std::ranges::copy_if(columns, std::back_inserter(some), wanted);
    if (!some.empty()) columns = std::move(some);
}

/// Columns that may hold the shares; densities are apart.
std::vector<std::size_t> share_columns(const ExportGrid& grid, const Headings& headings, const ExportColumns& found,
                                       std::vector<std::size_t>& densities) {
    std::vector<std::size_t> shares;
    for (std::size_t j = 0; j < headings.size(); ++j) {
        if (j == found.size || j == found.upper || headings[j].ignored || headings[j].with_sieve || !is_filled(grid, j))
            continue;
        const bool percents = headings[j].plain.find('%') != std::string::npos;
        if ((headings[j].size && !headings[j].share) || (!percents && counts_up(grid, j) && grid.rows.size() > 3))
            continue;
        if (headings[j].density)
            densities.push_back(j);
        else if (headings[j].share || grid.headers[j].empty())
            shares.push_back(j);
    }
    return shares;
}

/// Whether two columns hold the same shares in two units, as weights and percents do. Two columns of one unit are two
/// samples unless they are equal.
bool are_alike(const ExportGrid& grid, const Headings& headings, std::size_t a, std::size_t b) {
    const auto is_percent = [&](std::size_t j) { return headings[j].plain.find('%') != std::string::npos; };
    const double rounding = is_percent(a) == is_percent(b) ? 1e-9 : 0.005;  // of the whole
    const auto value = [&](std::size_t k, std::size_t j) { return number_at(grid, k, j).value_or(0); };
    bool rises = true, falls = true;
    for (std::size_t k = 1; k < grid.rows.size(); ++k) {
        rises = rises && value(k, a) >= value(k - 1, a);
        falls = falls && value(k, a) <= value(k - 1, a);
    }
    double whole_a = 0, whole_b = 0;  // of sums the largest one, of classes their sum
    for (std::size_t k = 0; k < grid.rows.size(); ++k) {
        whole_a = rises || falls ? std::max(whole_a, value(k, a)) : whole_a + value(k, a);
        whole_b = rises || falls ? std::max(whole_b, value(k, b)) : whole_b + value(k, b);
    }
    if (!(whole_a > 0 && whole_b > 0)) return false;
    for (std::size_t k = 0; k < grid.rows.size(); ++k)
        if (!(std::abs(value(k, a) / whole_a - value(k, b) / whole_b) <= rounding)) return false;
    return true;
}

std::size_t share_column(const ExportGrid& grid, const Headings& headings, const ExportChoices& choices,
                         const ExportColumns& found) {
    std::vector<std::size_t> with_sieves;
    for (std::size_t j = 0; j < headings.size(); ++j)
        if (headings[j].with_sieve && is_filled(grid, j)) with_sieves.push_back(j);
    const auto refuse_weights = [&](const std::vector<std::size_t>& columns) {
        refuse_export(
            fmt::format("{} weighs the sieve too: add a column of what each sieve retained, the difference "
                        "of its weights with and without powder",
                        column_list(grid, columns)));
    };
    if (choices.shares) {
        const auto chosen = chosen_column(grid, "--shares", *choices.shares);
        if (headings[chosen].with_sieve) refuse_weights({chosen});
        return chosen;
    }
    std::vector<std::size_t> densities;
    auto shares = share_columns(grid, headings, found, densities);
    if (choices.sample && !grid.sample_chosen) {
        std::vector<std::size_t> named;  // "A" is a part of most headers: the whole name comes first
        for (const auto j : shares)
            if (grid.headers[j].starts_with(*choices.sample + ": ")) named.push_back(j);
        if (named.empty())
            std::ranges::copy_if(shares, std::back_inserter(named), [&](auto j) {
                return plain_words(grid.headers[j]).find(plain_words(*choices.sample)) != std::string::npos;
            });
        if (named.empty())
            throw input_error("--sample", *choices.sample,
                              fmt::format("no table, row or column has this name; the columns of shares are {}",
                                          column_list(grid, shares)));
        shares = std::move(named);
    }
    if (choices.by)
        keep_if_any(shares, [&](auto j) { return headings[j].by == (*choices.by == "mass" ? "volume" : *choices.by); });
    else
        keep_if_any(shares, [&](auto j) { return headings[j].by != "intensity"; });
    // A cumulative column needs no edges of classes: it is taken before others.
    for (const char* kind : {"passing", "sum", "retained", "each"}) {
        std::vector<std::size_t> of_kind;
        for (const auto j : shares)
            if (headings[j].as == kind) of_kind.push_back(j);
        if (of_kind.size() == 1) return of_kind.front();
        if (of_kind.size() > 1) shares = of_kind;
        if (!of_kind.empty()) break;
    }
    if (shares.size() == 1) return shares.front();
    if (shares.size() > 1 && std::ranges::all_of(shares, [&](auto j) {
            const auto &a = headings[shares.front()].by, &b = headings[j].by;
            return (!a || !b || a == b) && are_alike(grid, headings, shares.front(), j);
        }))
        return shares.back();
    if (shares.empty() && !densities.empty())
        refuse_export(fmt::format("{} is a density, and neither a share nor a sum; export the cumulative shares",
                                  column_list(grid, densities)));
    if (shares.empty() && !with_sieves.empty()) refuse_weights(with_sieves);
    std::vector<std::size_t> all;
    for (std::size_t j = 0; j < grid.headers.size(); ++j)
        if (j != found.size && is_filled(grid, j)) all.push_back(j);
    refuse_export(fmt::format("which column holds the shares is not clear: state it by --shares, of {}",
                              column_list(grid, shares.empty() ? all : shares)));
}

/// The series of numbered sieves: by words, else the one that has all of them.
std::string series_of(const ExportGrid& grid, const ExportColumns& columns, std::string& from) {
    const std::string words = plain_words(grid.headers[columns.size]) + "\n" + grid.words;
    constexpr std::array<std::pair<std::string_view, std::string_view>, 8> named = {{{"tyler", "tyler"},
                                                                                     {"astm", "astm"},
                                                                                     {"e11", "astm"},
                                                                                     {"u.s. s", "astm"},
                                                                                     {"us s", "astm"},
                                                                                     {"us mesh", "astm"},
                                                                                     {"bs 410", "british"},
                                                                                     {"bss", "british"}}};
    for (const auto& [word, series] : named)
        if (words.find(word) != std::string::npos) return from = "its words", std::string(series);
    std::vector<std::string> fitting;
    std::vector<std::vector<double>> openings;
    for (std::size_t s = 0; s < sieve_series.size(); ++s) {
        bool all = true;
        std::vector<double> of_series;
        for (const auto& row : grid.rows) {
            const auto size = export_size(row[columns.size], grid.decimal_comma);
            if (!size || size->kind == ExportSize::Kind::pan || (!size->unit.empty() && size->unit != "mesh")) continue;
            for (const double number : {std::abs(size->low), std::abs(size->high)}) {
                const auto opening = sieve_opening(static_cast<SieveSeries>(s), number);
                all = all && opening.has_value();
                of_series.push_back(opening.value_or(0));
            }
        }
        if (all && !of_series.empty()) fitting.emplace_back(sieve_series[s]), openings.push_back(of_series);
    }
    from = "its numbers";
    if (!fitting.empty() && std::ranges::all_of(openings, [&](const auto& other) { return other == openings.front(); }))
        return fitting.front();
    if (fitting.empty()) return {};
    refuse_export(
        fmt::format("the numbers of sieves in column {} may be of {}, with other openings: state it by --unit astm, "
                    "--unit tyler or --unit british",
                    grid.numbers[columns.size], listed(fitting)));
}

void find_unit(const ExportGrid& grid, const Headings& headings, const ExportChoices& choices, ExportColumns& columns) {
    if (choices.unit) {
        columns.unit = *choices.unit, columns.unit_from = "--unit";
        return;
    }
    const auto& heading = headings[columns.size];
    std::string own;
    bool bare = false;
    for (const auto& row : grid.rows)
        if (const auto size = export_size(row[columns.size], grid.decimal_comma);
            size && size->kind != ExportSize::Kind::pan) {
            if (size->unit.empty()) bare = bare || size->low != 0 || size->high != 0;
            if (!size->unit.empty() && own != "mesh") own = size->unit;
        }
    if (own == "mesh" || (heading.sieve_number && bare)) {
        columns.unit = series_of(grid, columns, columns.unit_from);
        if (!columns.unit.empty()) return;
    }
    if (!heading.length.empty()) {
        columns.unit = heading.length, columns.unit_from = "its header";
        return;
    }
    if (!own.empty()) {
        columns.unit = own, columns.unit_from = "its cells";
        return;
    }
    std::vector<std::string> named;
    for (const std::string_view unit : {"um", "mm", "nm"})
        for (const std::string_view before : {" ", ":", ";", ",", "\t", "(", "["})
            for (const std::string_view behind : {"\n", " ", ";", ",", "\t", ")", "]"})
                if (grid.words.find(fmt::format("{}{}{}", before, unit, behind)) != std::string::npos &&
                    (named.empty() || named.back() != unit))
                    named.emplace_back(unit);
    if (named.size() == 1) {
        columns.unit = named.front(), columns.unit_from = "the lines around the table";
        return;
    }
    refuse_export(fmt::format("the unit of the sizes in column {} is not stated: give it by --unit, as in --unit um",
                              grid.numbers[columns.size]));
}

/// By volume or number, from the column itself, then from the lines around the table.
std::optional<std::string> basis_of(const ExportGrid& grid, const Headings& headings, const ExportColumns& columns) {
    const auto& share = headings[columns.share];
    if (share.by == "intensity")
        refuse_export(
            fmt::format("column {} is by intensity of scattered light, which is no share of particles: export "
                        "the distribution by volume",
                        columns.share_name));
    if (share.by) return share.by;
    if (headings[columns.size].by && !headings[columns.size].sieve_number) return headings[columns.size].by;
    if (columns.sieved) return "volume";
    const bool by_number = has_word(grid.words, around_number), by_volume = has_word(grid.words, around_volume);
    if (by_number == by_volume) return std::nullopt;
    return by_number ? "number" : "volume";
}

}  // namespace

std::string column_list(const ExportGrid& grid, const std::vector<std::size_t>& columns) {
    constexpr std::size_t most_listed = 12;
    std::string list;
    for (const auto column : columns | std::views::take(most_listed))
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", grid.numbers[column],
                            grid.headers[column].empty() ? "(no header)" : "'" + grid.headers[column] + "'");
    if (columns.size() > most_listed) list += fmt::format(" and {} more", columns.size() - most_listed);
    return list;
}

ExportColumns export_columns(const ExportGrid& grid, const ExportChoices& choices) {
    Headings headings;
    for (const auto& header : grid.headers) headings.push_back(export_heading(header));
    ExportColumns columns;
    columns.size = size_column(grid, headings, choices, columns.upper);
    columns.share = share_column(grid, headings, choices, columns);
    if (columns.size == columns.share)
        throw input_error("--shares", grid.headers[columns.share], "is the column of the sizes");
    const auto& heading = headings[columns.share];
    columns.as = heading.as;
    columns.radius = headings[columns.size].radius;
    columns.share_name = column_list(grid, {columns.share});
    columns.percent =
        heading.plain.find('%') != std::string::npos || heading.plain.find("percent") != std::string::npos;
    constexpr auto weights =
        std::to_array<std::string_view>({"(g)", "[g]", "(kg)", "[kg]", " g", "(mg)", "count", "(gr)", "[gr]", ", g"});
    const bool grams = heading.plain.ends_with("_g") || heading.plain == "g" || heading.plain.ends_with("/g");
    columns.weighed = !columns.percent && heading.as != "passing" && heading.as != "sum" &&
                      (grams || has_word(heading.plain, weights));
    const auto& size_header = headings[columns.size].plain;
    if (size_header.starts_with("log") || size_header.starts_with("lg ") || size_header.starts_with("ln ") ||
        has_word(size_header, std::to_array<std::string_view>({"log10", "log(", "lg(", "ln("})))
        refuse_export(
            fmt::format("column {} holds logarithms of sizes: export the sizes", column_list(grid, {columns.size})));
    if (has_word(size_header, lower_edge_words)) columns.edge = "lower";
    if (has_word(size_header, upper_edge_words)) columns.edge = "upper";
    const bool counted = heading.by == "number";
    const bool headed = std::ranges::any_of(headings, [](const auto& one) { return has_word(one.plain, sieve_words); });
    columns.sieved = !counted && (headed || has_word(grid.words, sieve_words) || headings[columns.size].sieve_number ||
                                  columns.weighed);
    find_unit(grid, headings, choices, columns);
    columns.by = basis_of(grid, headings, columns);
    return columns;
}

}  // namespace grainsweep::campaign
