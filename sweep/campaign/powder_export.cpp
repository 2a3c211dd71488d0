// Converts columns of sizes and shares to shares below rising sizes. Requests choices for missing information.
#include "sweep/campaign/powder_export.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder_export_curves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace grainsweep::campaign {
namespace {

using export_curves::Meaning;
using export_entries::Entry;
using export_entries::share_rounding;
using SizeKind = ExportSize::Kind;

void require_choice(const std::optional<std::string>& choice, std::string_view option,
                    std::span<const std::string_view> words) {
    if (choice && std::ranges::find(words, *choice) == words.end())
        throw input_error(option, *choice, fmt::format("must be one of {}", listed(words)),
                          nearest_word(*choice, words));
}

/// Sizes of grains, as tables of sizes allow them: others are of another unit or another column.
void require_sizes_of_grains(const ExportCurve& curve, const std::string& unit) {
    constexpr double smallest = 1e-8, largest = 0.1;  // m
    for (const double size : {curve.sizes.front(), curve.sizes.back()})
        if (!(size >= smallest && size <= largest))
            refuse_export(
                fmt::format("a size of {:.3g} m is none of a powder, from 10 nm to 100 mm; the sizes were read in "
                            "{}: state another unit by --unit, or the column by --sizes",
                            size, unit));
}

std::string separator_words(const ExportGrid& grid) {
    const char* name = grid.separator == '\t'  ? "tabs"
                       : grid.separator == ';' ? "semicolons"
                       : grid.separator == ',' ? "commas"
                       : grid.separator == '|' ? "bars"
                                               : "blanks";
    return fmt::format("{}, decimal {}", name, grid.decimal_comma ? "commas" : "points");
}

std::string micrometre_text(double size) {
    return fmt::format("{:.4g} um", 1e6 * size);
}

/// One reading of the rows: at which edge of its class a size lies, and what follows.
struct Curved {
    ExportCurve curve;
    std::string edge, edge_from;
    std::vector<std::string> notes;
};

/// The steps from rows to a curve, with the percentiles that the file states beside them.
class ExportConversion {
public:
    ExportConversion(const std::vector<Entry>& entries, const ExportColumns& columns, const ExportChoices& choices,
                     Meaning meaning, std::vector<StatedPercentile> stated)
        : entries_(entries),
          columns_(columns),
          choices_(choices),
          meaning_(std::move(meaning)),
          stated_(std::move(stated)) {
        std::erase_if(stated_, [&](const auto& one) { return one.by.value_or("volume") != meaning_.by; });
    }

    [[nodiscard]] Curved curved() const {
        if (meaning_.as != "each") {
            Curved result = with_edge(export_curves::edge_of_sums(entries_, meaning_, choices_));
            return result;
        }
        const auto& first = *std::ranges::find_if(entries_, [](const auto& entry) {
            return entry.size.kind != SizeKind::pan && entry.size.kind != SizeKind::below;
        });
        const bool ranges = &first != &*entries_.end() && first.size.kind == SizeKind::range;
        if (ranges) return with_edge("both");
        if (choices_.edge) return from(with_edge(*choices_.edge), "--edge");
        return by_evidence();
    }
    [[nodiscard]] std::vector<const StatedPercentile*> contradictions(const ExportCurve& curve) const {
        std::vector<const StatedPercentile*> all;
        for (const auto& one : stated_)
            if (!agrees(curve, one)) all.push_back(&one);
        return all;
    }
    [[nodiscard]] bool is_compared() const { return !stated_.empty(); }
    /// The other edge with which the file agrees.
    [[nodiscard]] std::optional<Curved> agreeing_other(const Curved& taken) const {
        if (meaning_.as != "each" || taken.edge == "both") return std::nullopt;
        for (const auto edge : export_edges)
            if (edge != taken.edge)
                if (auto other = fitting(std::string(edge))) return other;
        return std::nullopt;
    }

private:
    [[nodiscard]] static Curved from(Curved curved, std::string why) {
        curved.edge_from = std::move(why);
        return curved;
    }
    [[nodiscard]] Curved with_edge(const std::string& edge) const {
        Curved result;
        result.edge = edge;
        result.curve = meaning_.as == "each" ? export_curves::of_classes(entries_, edge, meaning_.whole)
                                             : export_curves::of_sums(entries_, meaning_, edge);
        export_curves::end_curve(result.curve, choices_, result.notes);
        export_curves::trim(result.curve);
        return result;
    }
    [[nodiscard]] std::optional<Curved> fitting(const std::string& edge) const {
        try {
            Curved curved = with_edge(edge);
            if (!stated_.empty() && contradictions(curved.curve).empty()) return curved;
        } catch (const InputError&) {  // an end is missing with this edge
        }
        return std::nullopt;
    }
    /// Whether the shares fade to a printed 0: the class may be one that rounds to 0, and no bare edge.
    [[nodiscard]] bool fades_to(const Entry& end, const Entry& next) const {
        constexpr double little = 0.01;  // of the whole
        return end.stated && next.share <= little * meaning_.whole;
    }
    /// What the other edges would give.
    [[nodiscard]] std::string doubt_of(const std::string& taken) const {
        std::string others;
        for (const auto edge : export_edges) {
            if (edge == taken) continue;
            try {
                const double middle = with_edge(std::string(edge)).curve.quantile(0.5);
                others += fmt::format("{} with --edge {} d50 is {}", others.empty() ? "" : ",", edge,
                                      micrometre_text(middle));
            } catch (const InputError&) {  // an end is missing with this edge
            }
        }
        return "the edge is a guess from shares that fade to 0;" + others;
    }
    /// By the kind of the instrument, by empty ends, or by the percentiles that the file states.
    [[nodiscard]] Curved by_evidence() const {
        std::string edge, why;
        const bool first_is_edge = entries_.front().share == 0, last_is_edge = entries_.back().share == 0;
        bool fades = false;
        if (columns_.edge) {
            edge = *columns_.edge, why = "the header of the sizes";
        } else if (columns_.sieved) {  // a sieve holds back particles larger than its openings
            edge = "lower", why = "sieves";
        } else if (first_is_edge != last_is_edge) {
            edge = first_is_edge ? "upper" : "lower";
            why = first_is_edge ? "no share at the smallest size" : "no share at the largest size";
            fades = first_is_edge ? fades_to(entries_.front(), entries_[1])
                                  : fades_to(entries_.back(), entries_[entries_.size() - 2]);
        }
        if (!edge.empty())
            if (auto curved = fitting(edge)) return from(*curved, why);
        if (!columns_.sieved) {
            auto lower = fitting("lower"), upper = fitting("upper");
            const std::string percentiles = "the percentiles that the file states";
            if (lower && !upper) return from(*lower, percentiles);
            if (upper && !lower) return from(*upper, percentiles);
            if (!lower && !upper)
                if (auto middle = fitting("middle")) return from(*middle, percentiles);
        }
        if (edge.empty())
            refuse_export(
                fmt::format("column {} gives the share of each class, and whether its size is the lower edge of the "
                            "class, the upper one or the middle is not stated: give it by --edge",
                            columns_.share_name));
        Curved curved = with_edge(edge);
        if (fades) curved.notes.push_back(doubt_of(edge));
        return from(std::move(curved), why);
    }

    const std::vector<Entry>& entries_;
    const ExportColumns& columns_;
    const ExportChoices& choices_;
    Meaning meaning_;
    std::vector<StatedPercentile> stated_;
};

Meaning meaning_of(const std::vector<Entry>& entries, const ExportColumns& columns, const ExportChoices& choices,
                   std::vector<std::string>& notes) {
    Meaning meaning;
    meaning.as = export_entries::kind_of_shares(entries, columns, choices, meaning.as_from);
    const auto by = choices.by ? choices.by : columns.by;
    if (!by)
        refuse_export(
            fmt::format("whether the shares of column {} are by volume or by number is not stated: give it by "
                        "--by (laser diffraction and sieves give volume or mass)",
                        columns.share_name));
    meaning.by = *by == "mass" ? "volume" : *by;
    const double end = meaning.as == "passing" ? entries.back().share : entries.front().share;
    meaning.whole = export_entries::whole_of(entries, meaning.as, columns, end, notes);
    if (meaning.as == "each" && std::abs(meaning.whole - 1) > share_rounding &&
        std::abs(meaning.whole - 100) > 100 * share_rounding)
        notes.push_back(fmt::format("the shares add up to {:.6g} and are divided by it", meaning.whole));
    return meaning;
}

std::string meaning_words(const Meaning& meaning, const Curved& curved) {
    const std::string at = curved.edge.empty() || curved.edge == "both" ? "" : curved.edge + " edge";
    if (meaning.as != "each")
        return fmt::format("shares {} {}", meaning.as == "passing" ? "below" : "above",
                           at.empty() ? "each size" : "the " + at + " of each class");
    return fmt::format("shares of classes, whose {} the sizes give", curved.edge == "both"     ? "edges"
                                                                     : curved.edge == "middle" ? "middle"
                                                                                               : at);
}

/// One sentence with all percentiles that differ.
std::vector<std::string> differences_of(const ExportConversion& conversion, const Curved& curved) {
    const auto wrong = conversion.contradictions(curved.curve);
    if (wrong.empty()) return {};
    std::vector<std::string> stated, given;
    for (const auto* one : wrong) {
        stated.push_back(one->name);
        given.push_back(micrometre_text(curved.curve.quantile(one->share)));
    }
    std::string sentence =
        fmt::format("the file states {}, and the import gives {}", fmt::join(stated, ", "), fmt::join(given, ", "));
    if (const auto other = conversion.agreeing_other(curved))
        sentence += fmt::format("; with --edge {} it gives {}", other->edge,
                                micrometre_text(other->curve.quantile(wrong.front()->share)));
    return {sentence};
}

}  // namespace

double ExportCurve::quantile(double share) const {
    std::size_t k = 1;
    while (k + 1 < below.size() && below[k] < share) ++k;
    const double step = below[k] - below[k - 1];
    const double u = step > 0 ? (share - below[k - 1]) / step : 0;
    return sizes[k - 1] + u * (sizes[k] - sizes[k - 1]);
}

ImportedSizes import_sizes(std::string_view bytes, const ExportChoices& choices) {
    require_choice(choices.as, "--as", export_as);
    require_choice(choices.by, "--by", export_by);
    require_choice(choices.edge, "--edge", export_edges);
    const ExportGrid grid = export_grid(bytes, choices);
    const ExportColumns columns = export_columns(grid, choices);
    ImportedSizes result;
    result.notes = grid.notes;
    if (columns.radius)
        result.notes.push_back(
            fmt::format("column {} holds radii: diameters are twice as large", grid.numbers[columns.size]));
    const auto entries = export_entries::entries_of(grid, columns, result.notes);
    const Meaning meaning = meaning_of(entries, columns, choices, result.notes);
    const bool classes = std::ranges::any_of(entries, [](const auto& one) { return one.size.kind == SizeKind::range; });
    if (choices.edge && meaning.as != "each" && !classes)
        throw input_error("--edge", *choices.edge,
                          fmt::format("has no effect: the shares are '{}' a size", meaning.as));
    const bool length = !length_unit(columns.unit).empty() && columns.unit != "in";
    const ExportConversion conversion(entries, columns, choices, meaning,
                                      stated_percentiles(grid, length ? columns.unit : "um"));
    const Curved curved = conversion.curved();
    const auto& curve = curved.curve;
    result.notes.insert(result.notes.end(), curved.notes.begin(), curved.notes.end());
    require_sizes_of_grains(curve, columns.unit);
    result.warnings = differences_of(conversion, curved);

    result.csv = fmt::format("diameter,{}_below\n", meaning.by);
    for (std::size_t k = 0; k < curve.sizes.size(); ++k)
        result.csv += fmt::format("{},{}\n", shortest(curve.sizes[k]), shortest(curve.below[k]));
    const std::string words = meaning_words(meaning, curved);
    result.sentence = fmt::format("{} sizes from {} to {}, by {}: {}; d10 {}, d50 {}, d90 {}", curve.sizes.size(),
                                  micrometre_text(curve.sizes.front()), micrometre_text(curve.sizes.back()), meaning.by,
                                  words, micrometre_text(curve.quantile(0.1)), micrometre_text(curve.quantile(0.5)),
                                  micrometre_text(curve.quantile(0.9)));
    const auto header = [&](std::size_t column) {
        const auto number = grid.numbers[column];
        return grid.headers[column].empty() ? fmt::format("column {}", number)
                                            : fmt::format("column {}, '{}'", number, grid.headers[column]);
    };
    const std::string sizes =
        columns.upper ? fmt::format("{} to {}", header(columns.size), header(*columns.upper)) : header(columns.size);
    result.facts = {{"text", grid.encoding},
                    {"columns apart by", separator_words(grid)},
                    {"lines", fmt::format("{} to {}", grid.lines.front(), grid.lines.back())},
                    {"sizes", fmt::format("{}, in {} ({})", sizes, columns.unit, columns.unit_from)},
                    {"shares", header(columns.share)},
                    {"meaning", fmt::format("{} ({}{})", words, meaning.as_from,
                                            curved.edge_from.empty() ? "" : "; the edge: " + curved.edge_from)},
                    {"by", fmt::format("{} ({})", meaning.by, choices.by ? "--by" : "the file")}};
    if (conversion.is_compared())
        result.facts.emplace_back("percentiles stated",
                                  result.warnings.empty() ? "agree with the import, within its classes" : "differ");
    return result;
}

}  // namespace grainsweep::campaign
