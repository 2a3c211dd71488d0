#include "sweep/campaign/powder_export_curves.hpp"

#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::campaign::export_curves {
namespace {

using export_entries::metres;
using export_entries::share_rounding;
using export_entries::small_rest;
using SizeKind = ExportSize::Kind;

/// Shares of rows that are classes; below and above: of rows without a size at one side.
struct Classes {
    std::vector<Entry> rows;
    double below = 0, above = 0;
};

Classes classes_of(const std::vector<Entry>& entries, double whole) {
    Classes classes;
    double smallest = 0;
    for (const auto& entry : entries) {
        if (entry.size.kind == SizeKind::below) smallest = entry.size.high;
        if (entry.size.kind == SizeKind::pan || entry.size.kind == SizeKind::below)
            classes.below += entry.share / whole;
        else if (entry.size.kind == SizeKind::above)
            classes.above += entry.share / whole;
        else
            classes.rows.push_back(entry);
    }
    if (classes.rows.empty()) refuse_export("its table has no class with two edges");
    const double first = classes.rows.front().size.low;
    if (smallest > 0 && classes.below > small_rest && std::abs(smallest / first - 1) > 1e-6)
        refuse_export(fmt::format("a class ends at {:.4g} um, and the one above it begins at {:.4g} um", 1e6 * smallest,
                                  1e6 * first));
    return classes;
}

}  // namespace

ExportCurve of_classes(const std::vector<Entry>& entries, const std::string& edge, double whole) {
    const Classes classes = classes_of(entries, whole);
    ExportCurve curve;
    double below = classes.below;
    const auto add = [&](double at, double share) {
        curve.sizes.push_back(at);
        curve.below.push_back(share);
    };
    const auto& rows = classes.rows;
    const std::size_t n = rows.size();
    if (edge == "both") {
        add(rows[0].size.low, below);
        for (std::size_t k = 0; k < n; ++k) {
            if (rows[k].size.kind != SizeKind::range)
                refuse_export(fmt::format("line {}: it has one size, and other lines have two", rows[k].line));
            if (k > 0 && std::abs(rows[k].size.low / rows[k - 1].size.high - 1) > 1e-6)
                refuse_export(
                    fmt::format("line {}: the class begins at {:.4g} um, and the one below it ends at {:.4g} um",
                                rows[k].line, 1e6 * rows[k].size.low, 1e6 * rows[k - 1].size.high));
            add(rows[k].size.high, curve.below.back() + rows[k].share / whole);
        }
    } else if (edge == "lower") {
        for (const auto& row : rows) {
            add(row.size.low, below);
            below += row.share / whole;
        }
    } else if (edge == "upper") {
        for (const auto& row : rows) add(row.size.low, below += row.share / whole);
    } else {  // edges half way between, on the scale of ratios; the outermost as far outside as the next is inside
        if (n < 2) refuse_export("one class has no neighbours that would give its edges");
        const auto mid = [&](std::size_t k) { return rows[k].size.low; };
        add(mid(0) * std::sqrt(mid(0) / mid(1)), below);
        for (std::size_t k = 0; k < n; ++k)
            add(k + 1 < n ? std::sqrt(mid(k) * mid(k + 1)) : mid(k) * std::sqrt(mid(k) / mid(k - 1)),
                below += rows[k].share / whole);
    }
    // ">90" starts at the last edge; with lower edges it is the remaining share.
    if (classes.above > 0 && edge != "lower" && std::abs(curve.below.back() + classes.above - 1) > small_rest)
        refuse_export("the shares of its classes do not add up");
    return curve;
}

std::string edge_of_sums(const std::vector<Entry>& entries, const Meaning& meaning, const ExportChoices& choices) {
    const Entry *first = nullptr, *last = nullptr;
    for (const auto& entry : entries)
        if (entry.size.kind == SizeKind::range) {
            if (first == nullptr) first = &entry;
            last = &entry;
        }
    if (first == nullptr) return {};
    if (choices.edge) return *choices.edge;
    const double begin = first->share / meaning.whole, end = last->share / meaning.whole;
    if (meaning.as == "passing") return end < 1 - small_rest && begin < share_rounding ? "lower" : "upper";
    const bool all_at_first = begin > 1 - share_rounding, none_at_last = end < share_rounding;
    if (all_at_first == none_at_last)
        refuse_export(
            "whether the sums above a size are given at the lower or the upper edges of the classes is not "
            "stated: give it by --edge");
    return all_at_first ? "lower" : "upper";
}

ExportCurve of_sums(const std::vector<Entry>& entries, const Meaning& meaning, const std::string& edge) {
    ExportCurve curve;
    for (const auto& entry : entries) {
        const double share = entry.share / meaning.whole;
        const double below = meaning.as == "passing" ? share : 1 - share;
        if (entry.size.kind == SizeKind::pan) {  // all is above it
            if (below > small_rest)
                refuse_export(fmt::format("line {}: {:.3g} % lie below a size of 0", entry.line, 100 * below));
            continue;
        }
        const bool open = (entry.size.kind == SizeKind::above && edge == "upper") ||
                          (entry.size.kind == SizeKind::below && edge == "lower");
        if (!entry.stated || open) continue;
        if (curve.sizes.empty() && edge == "upper" && entry.size.kind == SizeKind::range) {
            curve.sizes.push_back(entry.size.low);  // the first class holds all that is below its upper edge
            curve.below.push_back(0);
        }
        curve.sizes.push_back(edge == "upper" ? entry.size.high : entry.size.low);
        curve.below.push_back(below);
    }
    if (edge == "lower" && !entries.empty() && entries.back().size.kind == SizeKind::range) {
        curve.sizes.push_back(entries.back().size.high);
        curve.below.push_back(1);
    }
    if (curve.sizes.size() < 2) refuse_export("fewer than two sizes with shares are in its table");
    return curve;
}

void end_curve(ExportCurve& curve, const ExportChoices& choices, std::vector<std::string>& notes) {
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
    if (first > share_rounding) notes.push_back(fmt::format("{} below the first size are left out", percent(first)));
    if (std::abs(last - 1) > share_rounding)
        notes.push_back(fmt::format("the shares end at {} and are divided by it", percent(last)));
    for (double& share : curve.below) share = std::clamp((share - first) / (last - first), 0.0, 1.0);
    curve.below.front() = 0, curve.below.back() = 1;
    for (std::size_t k = 1; k < curve.below.size(); ++k) curve.below[k] = std::max(curve.below[k], curve.below[k - 1]);
}

void trim(ExportCurve& curve) {
    std::size_t first = 0, last = curve.sizes.size() - 1;
    while (first + 1 < last && curve.below[first + 1] <= 0) ++first;
    while (last > first + 1 && curve.below[last - 1] >= 1) --last;
    const auto part = [&](std::vector<double>& all) {
        all = {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last) + 1};
    };
    part(curve.sizes), part(curve.below);
}

}  // namespace grainsweep::campaign::export_curves
