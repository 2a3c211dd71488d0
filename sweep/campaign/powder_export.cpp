// Converts columns of sizes and shares to shares below rising sizes. Requests choices for missing information.
#include "sweep/campaign/powder_export.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace grainsweep::campaign {
namespace {

constexpr double small_rest = 0.01;  // relative: by which shares may miss their whole
constexpr double rounding = 1e-9;

/// Size and printed share of one row.
struct Entry {
    ExportSize size;
    double share = 0;
    std::size_t line = 0;
};

/// Shares below rising sizes (m) as parts of the whole; the first and last need not be 0 and 1.
struct Curve {
    std::vector<double> sizes, below;
};

[[noreturn]] void refuse_export(const std::string& why) {
    throw input_error("EXPORT", "", why);
}

void require_choice(const std::optional<std::string>& choice, std::string_view option,
                    std::span<const std::string_view> words) {
    if (choice && std::ranges::find(words, *choice) == words.end())
        throw input_error(option, *choice, fmt::format("must be one of {}", listed(words)),
                          nearest_word(*choice, words));
}

double metres(const std::string& text, std::string_view option) {
    const auto value = in_si(text, "m");
    if (const auto* why = std::get_if<std::string>(&value)) throw input_error(option, text, *why);
    if (!(std::get<double>(value) > 0)) throw input_error(option, text, "must be a size above 0");
    return std::get<double>(value);
}

/// The size in metres as if it were written so by hand.
double in_metres(double size, const std::string& unit) {
    return metres(fmt::format("{} {}", shortest(size), unit), "--unit");
}

std::vector<Entry> entries_of(const ExportGrid& grid, const ExportColumns& columns) {
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < grid.rows.size(); ++k) {
        const auto& row = grid.rows[k];
        auto size = export_size(row[columns.size], grid.decimal_comma);
        if (!size) continue;
        const auto share = export_number(row[columns.share], grid.decimal_comma);
        if (columns.upper && size->kind == ExportSize::Kind::point)
            if (const auto upper = export_number(row[*columns.upper], grid.decimal_comma)) {
                size->kind = ExportSize::Kind::range;
                size->high = upper->value;
            }
        entries.push_back({*size, share ? share->value : 0, grid.first_line + k});
        if (entries.back().share < 0) refuse_export(fmt::format("line {}: a share is negative", entries.back().line));
    }
    // From the smallest on; a pan is below everything, ">90" above.
    const auto rank = [](const Entry& one) {
        return one.size.kind == ExportSize::Kind::pan     ? 0
               : one.size.kind == ExportSize::Kind::below ? 1
               : one.size.kind == ExportSize::Kind::above ? 3
                                                          : 2;
    };
    std::ranges::stable_sort(entries, [&](const Entry& a, const Entry& b) {
        return std::pair(rank(a), a.size.low) < std::pair(rank(b), b.size.low);
    });
    for (std::size_t k = 1; k < entries.size(); ++k)
        if (rank(entries[k]) == 2 && rank(entries[k - 1]) == 2 && !(entries[k].size.low > entries[k - 1].size.low))
            refuse_export(
                fmt::format("line {}: the size {} is there twice; where the file has several samples, leave "
                            "one",
                            entries[k].line, shortest(entries[k].size.low)));
    if (entries.size() < 2) refuse_export("fewer than two sizes are in its table");
    return entries;
}

/// Meanings of a column that its numbers allow.
struct Allowed {
    bool passing = true, retained = true, each = true;
};

bool near_whole(double total) {
    return std::abs(total - 1) <= small_rest || std::abs(total - 100) <= 100 * small_rest;
}

Allowed allowed_by(const std::vector<Entry>& entries, const ExportColumns& columns) {
    Allowed allowed;
    double sum = 0;
    for (std::size_t k = 0; k < entries.size(); ++k) {
        sum += entries[k].share;
        const auto kind = entries[k].size.kind;
        if (k > 0) {
            allowed.passing = allowed.passing && entries[k].share >= entries[k - 1].share - rounding;
            allowed.retained = allowed.retained && entries[k].share <= entries[k - 1].share + rounding;
        }
        if (kind != ExportSize::Kind::point && kind != ExportSize::Kind::pan)
            allowed.passing = allowed.retained = false;
    }
    if (columns.weighed) allowed.passing = allowed.retained = false;
    allowed.each = columns.weighed || near_whole(sum);
    const double ends = std::max(entries.front().share, entries.back().share);
    const double half = 0.5 * (columns.percent || ends > 1.5 ? 100 : 1);
    allowed.passing = allowed.passing && entries.back().share >= half;
    allowed.retained = allowed.retained && entries.front().share >= half;
    return allowed;
}

/// Returns passing, retained or each; requests a choice if neither words nor numbers decide.
std::string kind_of_shares(const std::vector<Entry>& entries, const ExportColumns& columns,
                           const ExportChoices& choices, std::string& from) {
    if (choices.as) return from = "--as", *choices.as;
    const Allowed allowed = allowed_by(entries, columns);
    const bool words = columns.as && *columns.as != "sum";
    if (words) {
        from = "its header";
        const bool possible = *columns.as == "passing"    ? allowed.passing
                              : *columns.as == "retained" ? allowed.retained
                                                          : allowed.each;
        if (possible) return *columns.as;
        refuse_export(
            fmt::format("column {} is '{}' by its header, and its numbers are not: {}. State what it is by --as, "
                        "or take another column by --shares",
                        columns.share_name, *columns.as,
                        *columns.as == "each" ? "they do not add up to 1 or 100 %"
                                              : "they do not change with the size from 0 to 100 % as a sum does"));
    }
    const bool each = allowed.each && !columns.as;
    const int possible = (allowed.passing ? 1 : 0) + (allowed.retained ? 1 : 0) + (each ? 1 : 0);
    from = "its numbers";
    if (possible == 1) return allowed.passing ? "passing" : allowed.retained ? "retained" : "each";
    if (possible == 0)
        refuse_export(
            fmt::format("column {} is no set of shares: it neither rises to 100 % nor falls from it nor adds up "
                        "to it; name another column by --shares, or state by --as what it is",
                        columns.share_name));
    refuse_export(
        fmt::format("column {} may be shares of classes or sums of them: state by --as whether it is "
                    "'passing' (below a size), 'retained' (above it) or 'each' (of a class)",
                    columns.share_name));
}

/// 1, 100, or of weighed classes their sum.
double whole_of(const std::vector<Entry>& entries, const std::string& as, const ExportColumns& columns, double end) {
    double sum = 0;
    for (const auto& entry : entries) sum += entry.share;
    if (as == "each" && columns.weighed) return sum;
    const double total = as == "each" ? sum : end;
    const double whole = columns.percent || total > 1.5 ? 100 : 1;
    if (as == "each" && !(std::abs(total - whole) <= small_rest * whole))
        refuse_export(fmt::format("the shares of column {} add up to {}, not to {}", columns.share_name,
                                  shortest(total), shortest(whole)));
    return as == "each" ? total : whole;
}

/// Returns whether sizes are the lower edges, the upper edges or the middles of their classes.
std::string edge_of(const std::vector<Entry>& entries, const ExportColumns& columns, const ExportChoices& choices) {
    if (choices.edge) return *choices.edge;
    if (columns.sieved) return "lower";  // a sieve holds back particles larger than its openings
    const bool first_is_edge = entries.front().share == 0, last_is_edge = entries.back().share == 0;
    if (first_is_edge && !last_is_edge) return "upper";
    if (last_is_edge && !first_is_edge) return "lower";
    refuse_export(
        fmt::format("column {} gives the share of each class, and whether its size is the lower edge of the "
                    "class, the upper one or the middle is not stated: give it by --edge",
                    columns.share_name));
}

Curve of_classes(const std::vector<Entry>& entries, const ExportColumns& columns, const ExportChoices& choices,
                 double whole, std::string& edge) {
    using Kind = ExportSize::Kind;
    Curve curve;
    double below = 0, above = 0;  // shares without a size at one side
    std::vector<Entry> classes;
    for (const auto& entry : entries) {
        if (entry.size.kind == Kind::pan || entry.size.kind == Kind::below)
            below += entry.share / whole;
        else if (entry.size.kind == Kind::above)
            above += entry.share / whole;
        else
            classes.push_back(entry);
    }
    if (classes.empty()) refuse_export("its table has no class with two edges");
    const auto size = [&](double value) { return in_metres(value, columns.unit); };
    const auto add = [&](double at, double share) {
        curve.sizes.push_back(at);
        curve.below.push_back(share);
    };
    const std::size_t n = classes.size();
    edge = classes.front().size.kind == Kind::range ? "both" : edge_of(entries, columns, choices);
    if (edge == "both") {
        add(size(classes[0].size.low), below);
        for (std::size_t k = 0; k < n; ++k) {
            if (k > 0 && std::abs(classes[k].size.low / classes[k - 1].size.high - 1) > 1e-6)
                refuse_export(fmt::format("line {}: the class begins at {}, and the one below it ends at {}",
                                          classes[k].line, shortest(classes[k].size.low),
                                          shortest(classes[k - 1].size.high)));
            add(size(classes[k].size.high), curve.below.back() + classes[k].share / whole);
        }
    } else if (edge == "lower") {
        for (std::size_t k = 0; k < n; ++k) {
            add(size(classes[k].size.low), below);
            below += classes[k].share / whole;
        }
    } else if (edge == "upper") {
        for (std::size_t k = 0; k < n; ++k) add(size(classes[k].size.low), below += classes[k].share / whole);
    } else {  // edges half way between, on the scale of ratios; the outermost as far outside as the next is inside
        if (n < 2) refuse_export("one class has no neighbours that would give its edges");
        const auto mid = [&](std::size_t k) { return size(classes[k].size.low); };
        add(mid(0) * std::sqrt(mid(0) / mid(1)), below);
        for (std::size_t k = 0; k < n; ++k)
            add(k + 1 < n ? std::sqrt(mid(k) * mid(k + 1)) : mid(k) * std::sqrt(mid(k) / mid(k - 1)),
                below += classes[k].share / whole);
    }
    // ">90" starts at the last edge; with lower edges it is the remaining share.
    if (above > 0 && edge != "lower" && std::abs(curve.below.back() + above - 1) > small_rest)
        refuse_export("the shares of its classes do not add up");
    return curve;
}

Curve of_sums(const std::vector<Entry>& entries, const ExportColumns& columns, const std::string& as, double whole) {
    Curve curve;
    for (const auto& entry : entries) {
        if (entry.size.kind == ExportSize::Kind::pan) continue;  // all is above it
        curve.sizes.push_back(in_metres(entry.size.low, columns.unit));
        const double share = entry.share / whole;
        curve.below.push_back(as == "passing" ? share : 1 - share);
    }
    return curve;
}

/// Gives the curve its ends: by choices, by leaving out a small rest, or by asking.
void end_curve(Curve& curve, const ExportChoices& choices, std::vector<std::string>& notes) {
    const auto percent = [](double share) { return fmt::format("{:.3g} %", 100 * share); };
    if (choices.smallest) {
        const double smallest = metres(*choices.smallest, "--smallest");
        if (!(smallest < curve.sizes.front()))
            throw input_error("--smallest", *choices.smallest,
                              fmt::format("must be below the first size, {:.4g} m", curve.sizes.front()));
        curve.sizes.insert(curve.sizes.begin(), smallest);
        curve.below.insert(curve.below.begin(), 0);
    } else if (curve.below.front() > small_rest) {
        refuse_export(
            fmt::format("{} lie below the first size, {:.4g} um, without a lower end: give one by --smallest, as "
                        "in --smallest \"5 um\"",
                        percent(curve.below.front()), 1e6 * curve.sizes.front()));
    }
    const double above = 1 - curve.below.back();
    if (choices.largest) {
        const double largest = metres(*choices.largest, "--largest");
        if (!(largest > curve.sizes.back()))
            throw input_error("--largest", *choices.largest,
                              fmt::format("must be above the last size, {:.4g} m", curve.sizes.back()));
        curve.sizes.push_back(largest);
        curve.below.push_back(1);
    } else if (above > small_rest) {
        refuse_export(
            fmt::format("{} lie above the last size, {:.4g} um, without an upper end: give one by --largest, as "
                        "in --largest \"120 um\"",
                        percent(above), 1e6 * curve.sizes.back()));
    }
    const double first = curve.below.front(), last = curve.below.back();
    if (first > rounding) notes.push_back(fmt::format("{} below the first size are left out", percent(first)));
    if (std::abs(last - 1) > rounding)
        notes.push_back(fmt::format("the shares end at {} and are divided by it", percent(last)));
    for (double& share : curve.below) share = std::clamp((share - first) / (last - first), 0.0, 1.0);
    curve.below.front() = 0, curve.below.back() = 1;
    for (std::size_t k = 1; k < curve.below.size(); ++k) curve.below[k] = std::max(curve.below[k], curve.below[k - 1]);
}

/// Sizes of grains, from a nanometre to a metre: others are of another unit or another column.
void require_sizes_of_grains(const Curve& curve, const std::string& unit) {
    constexpr double smallest = 1e-9, largest = 1;  // m
    for (const double size : {curve.sizes.front(), curve.sizes.back()})
        if (!(size >= smallest && size <= largest))
            refuse_export(
                fmt::format("a size of {:.3g} m is none of a powder, from 1 nm to 1 m; the sizes were read in "
                            "{}: state another unit by --unit, or the column by --sizes",
                            size, unit));
}

/// Removes the empty classes at both ends.
void trim(Curve& curve) {
    std::size_t first = 0, last = curve.sizes.size() - 1;
    while (first + 1 < last && curve.below[first + 1] <= 0) ++first;
    while (last > first + 1 && curve.below[last - 1] >= 1) --last;
    const auto part = [&](std::vector<double>& all) {
        all = {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last) + 1};
    };
    part(curve.sizes), part(curve.below);
}

double quantile(const Curve& curve, double share) {
    std::size_t k = 1;
    while (k + 1 < curve.below.size() && curve.below[k] < share) ++k;
    const double step = curve.below[k] - curve.below[k - 1];
    const double u = step > 0 ? (share - curve.below[k - 1]) / step : 0;
    return curve.sizes[k - 1] + u * (curve.sizes[k] - curve.sizes[k - 1]);
}

std::string separator_words(const ExportGrid& grid) {
    const char* name = grid.separator == '\t'  ? "tabs"
                       : grid.separator == ';' ? "semicolons"
                       : grid.separator == ',' ? "commas"
                                               : "blanks";
    return fmt::format("{}, decimal {}", name, grid.decimal_comma ? "commas" : "points");
}

}  // namespace

ImportedSizes import_sizes(std::string_view bytes, const ExportChoices& choices) {
    require_choice(choices.as, "--as", export_as);
    require_choice(choices.by, "--by", export_by);
    require_choice(choices.edge, "--edge", export_edges);
    const ExportGrid grid = export_grid(bytes);
    const ExportColumns columns = export_columns(grid, choices);
    const auto entries = entries_of(grid, columns);
    std::string as_from, edge;
    const std::string as = kind_of_shares(entries, columns, choices, as_from);
    if (choices.edge && as != "each")
        throw input_error("--edge", *choices.edge, fmt::format("has no effect: the shares are '{}' a size", as));
    const auto by = choices.by ? choices.by : columns.by;
    if (!by)
        refuse_export(
            fmt::format("whether the shares of column {} are by volume or by number is not stated: give it by "
                        "--by (laser diffraction and sieves give volume or mass)",
                        columns.share_name));
    ImportedSizes result;
    const double end = as == "passing" ? entries.back().share : entries.front().share;
    const double whole = whole_of(entries, as, columns, end);
    Curve curve =
        as == "each" ? of_classes(entries, columns, choices, whole, edge) : of_sums(entries, columns, as, whole);
    if (as == "each" && std::abs(whole - 1) > rounding && std::abs(whole - 100) > 100 * rounding)
        result.notes.push_back(fmt::format("the shares add up to {} and are divided by it", shortest(whole)));
    end_curve(curve, choices, result.notes);
    trim(curve);
    require_sizes_of_grains(curve, columns.unit);

    result.csv = fmt::format("diameter,{}_below\n", *by);
    for (std::size_t k = 0; k < curve.sizes.size(); ++k)
        result.csv += fmt::format("{},{}\n", shortest(curve.sizes[k]), shortest(curve.below[k]));
    const auto um = [](double size) { return fmt::format("{:.4g} um", 1e6 * size); };
    const std::string meaning = as == "passing"    ? "shares below each size"
                                : as == "retained" ? "shares above each size"
                                                   : fmt::format("shares of classes, whose {} the sizes give",
                                                                 edge == "both"     ? "edges"
                                                                 : edge == "middle" ? "middle"
                                                                                    : edge + " edge");
    result.sentence = fmt::format("{} sizes from {} to {}, by {}: {}; d10 {}, d50 {}, d90 {}", curve.sizes.size(),
                                  um(curve.sizes.front()), um(curve.sizes.back()), *by, meaning,
                                  um(quantile(curve, 0.1)), um(quantile(curve, 0.5)), um(quantile(curve, 0.9)));
    const auto header = [&](std::size_t column) {
        return grid.headers[column].empty() ? fmt::format("column {}", column + 1)
                                            : fmt::format("column {}, '{}'", column + 1, grid.headers[column]);
    };
    result.facts = {{"text", grid.encoding},
                    {"columns apart by", separator_words(grid)},
                    {"lines", fmt::format("{} to {}", grid.first_line, grid.last_line)},
                    {"sizes", fmt::format("{}, in {} ({})", header(columns.size), columns.unit, columns.unit_from)},
                    {"shares", header(columns.share)},
                    {"meaning", fmt::format("{} ({})", meaning, as_from)},
                    {"by", fmt::format("{} ({})", *by, choices.by ? "--by" : "the file")}};
    return result;
}

}  // namespace grainsweep::campaign
