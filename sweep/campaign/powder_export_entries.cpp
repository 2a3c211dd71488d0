// Reads rows of an export, and decides by words and numbers what their shares are.
#include "sweep/campaign/powder_export_entries.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sieve_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grainsweep::campaign::export_entries {
namespace {

/// The size in metres as if it were written so by hand: "425 um".
double written_in_metres(double size, std::string_view unit) {
    return metres(fmt::format("{} {}", shortest(size), unit), "--unit");
}

/// A size in the unit of its cell or column: a length, the number of a sieve, or phi.
double in_metres(double size, const std::string& unit, bool sieved, std::size_t line) {
    if (unit == "phi") return written_in_metres(phi_size(size), "um");
    if (const auto series = std::ranges::find(sieve_series, unit); series != sieve_series.end()) {
        const auto opening = sieve_opening(static_cast<SieveSeries>(series - sieve_series.begin()), size);
        if (!opening) refuse_export(fmt::format("line {}: the series {} has no sieve {}", line, unit, shortest(size)));
        return written_in_metres(*opening, "um");
    }
    if (unit == "in") {
        const auto opening = sieved ? inch_sieve_opening(size) : std::nullopt;
        return opening ? written_in_metres(*opening, "um") : written_in_metres(25.4 * size, "mm");
    }
    return written_in_metres(size, unit);
}

/// Converts the limits of a size; 0 as the smallest size of a length is the pan.
void convert(ExportSize& size, const ExportColumns& columns, std::size_t line) {
    using Kind = ExportSize::Kind;
    if (size.kind == Kind::pan) return;
    const bool own = !size.unit.empty() && size.unit != "mesh";
    const std::string unit = own ? size.unit : columns.unit;
    const double diameters = columns.radius ? 2 : 1;
    const auto at = [&](double value) { return diameters * in_metres(value, unit, columns.sieved, line); };
    if (unit != "phi" && size.low < 0) {  // "-200": through the sieve
        size.kind = Kind::below;
        size.low = size.high = at(-size.low);
        return;
    }
    if (unit != "phi" && size.kind == Kind::point && size.low == 0) {
        size.kind = Kind::pan;
        return;
    }
    if (unit != "phi" && size.kind == Kind::range && size.low == 0) {
        size.kind = Kind::below;
        size.low = size.high = at(size.high);
        return;
    }
    const double first = at(size.low), second = at(size.high);
    size.low = std::min(first, second), size.high = std::max(first, second);
    const bool coarser_first = unit == "phi" && (size.kind == Kind::below || size.kind == Kind::above);
    if (coarser_first) size.kind = size.kind == Kind::below ? Kind::above : Kind::below;
}

// From the smallest on; a pan is below everything, ">90" above.
int rank_of(const Entry& one) {
    switch (one.size.kind) {
        case ExportSize::Kind::pan:
            return 0;
        case ExportSize::Kind::below:
            return 1;
        case ExportSize::Kind::above:
            return 3;
        default:
            return 2;
    }
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
    std::optional<double> before, smallest, largest;
    for (const auto& entry : entries) {
        sum += entry.share;
        if (entry.size.kind == ExportSize::Kind::pan || !entry.stated) continue;
        if (before) {
            allowed.passing = allowed.passing && entry.share >= *before - share_rounding;
            allowed.retained = allowed.retained && entry.share <= *before + share_rounding;
        }
        before = largest = entry.share;
        if (!smallest) smallest = entry.share;
        const bool point = entry.size.kind == ExportSize::Kind::point;
        const bool sums = columns.upper || columns.as;  // by two columns of edges, or by words
        if (!point && !sums) allowed.passing = allowed.retained = false;
    }
    if (columns.weighed) allowed.passing = allowed.retained = false;
    allowed.each = columns.weighed || near_whole(sum);
    const double ends = std::max(smallest.value_or(0), largest.value_or(0));
    const double half = 0.5 * (ends > 1.5 ? 100 : 1);
    // Shares that add up to a whole and end far from it are no sums.
    const auto ended = [&](double end) { return end >= half && (!near_whole(sum) || near_whole(end)); };
    allowed.passing = allowed.passing && ended(largest.value_or(0));
    allowed.retained = allowed.retained && ended(smallest.value_or(0));
    return allowed;
}

}  // namespace

double metres(const std::string& text, std::string_view option) {
    const auto value = in_si(text, "m");
    if (const auto* why = std::get_if<std::string>(&value)) throw input_error(option, text, *why);
    if (!(std::get<double>(value) > 0)) throw input_error(option, text, "must be a size above 0");
    return std::get<double>(value);
}

std::vector<Entry> entries_of(const ExportGrid& grid, const ExportColumns& columns, std::vector<std::string>& notes) {
    std::vector<Entry> entries;
    bool ranges = false;
    for (std::size_t k = 0; k < grid.rows.size(); ++k) {
        const auto& row = grid.rows[k];
        const auto share = export_number(row[columns.share], grid.decimal_comma);
        auto size = export_size(row[columns.size], grid.decimal_comma);
        if (!size) {
            if (share && share->value != 0)
                notes.push_back(fmt::format("line {} is left out: '{}' is no size", grid.lines[k], row[columns.size]));
            continue;
        }
        if (columns.upper && size->kind == ExportSize::Kind::point)
            if (const auto upper = export_number(row[*columns.upper], grid.decimal_comma)) {
                size->kind = ExportSize::Kind::range;
                size->high = upper->value;
            }
        convert(*size, columns, grid.lines[k]);
        ranges = ranges || size->kind == ExportSize::Kind::range;
        entries.push_back({*size, share ? share->value : 0, share.has_value(), grid.lines[k], row[columns.size]});
        if (entries.back().share < 0) refuse_export(fmt::format("line {}: a share is negative", entries.back().line));
    }
    for (auto& entry : entries)  // "+40" beside "-40+60" is all above it
        if (ranges && entry.size.retained_on && entry.size.kind == ExportSize::Kind::point)
            entry.size.kind = ExportSize::Kind::above;
    std::ranges::stable_sort(entries, [&](const Entry& a, const Entry& b) {
        return std::pair(rank_of(a), a.size.low) < std::pair(rank_of(b), b.size.low);
    });
    for (std::size_t k = 1; k < entries.size(); ++k)
        if (rank_of(entries[k]) == 2 && rank_of(entries[k - 1]) == 2 &&
            !(entries[k].size.low > entries[k - 1].size.low))
            refuse_export(
                fmt::format("line {}: the size {} is there twice; where the file has several samples, state one "
                            "by --sample or --shares",
                            entries[k].line, entries[k].cell));
    if (entries.size() < 2) refuse_export("fewer than two sizes are in its table");
    return entries;
}

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

double whole_of(const std::vector<Entry>& entries, const std::string& as, const ExportColumns& columns, double end,
                std::vector<std::string>& notes) {
    double sum = 0;
    for (const auto& entry : entries) sum += entry.share;
    if (as == "each" && columns.weighed) return sum;
    const double total = as == "each" ? sum : end;
    const bool fractions = std::abs(total - 1) <= small_rest;
    const double whole = total > 1.5 || (columns.percent && !fractions) ? 100 : 1;
    if (columns.percent && fractions)
        notes.push_back(fmt::format("column {} is named by percent and holds fractions of 1", columns.share_name));
    if (as == "each" && !(std::abs(total - whole) <= small_rest * whole))
        refuse_export(fmt::format("the shares of column {} add up to {:.6g}, not to {}", columns.share_name, total,
                                  shortest(whole)));
    return as == "each" ? total : whole;
}

}  // namespace grainsweep::campaign::export_entries
