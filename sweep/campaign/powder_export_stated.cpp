// Percentiles that the lines around a table state: "Dx (10),433 um", "d(0.5): 12.3", "x50 = 31 um", "10% D", rows and
// columns of several, and the list of percents over a list of sizes.
#include "sweep/campaign/powder_export.hpp"

#include "sweep/campaign/quantity.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <regex>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t most_lines = 1000;    // of a head
constexpr std::size_t longest_words = 400;  // of a line with percentiles; others are data

struct Label {
    double share = 0;
    std::optional<std::string> by;
    std::string unit;
    bool bare = false;  ///< a percentage alone, which may be anything
};

using Pieces = std::vector<std::string>;

/// Parts of a line: cells, and what stands before and behind a colon or an equals sign.
Pieces pieces_of(const std::string& line, char separator) {
    Pieces pieces(1);
    for (const char c : line) {
        const bool apart = c == ':' || c == '=' || c == '\t' || (c == separator && c != ' ');
        if (apart)
            pieces.emplace_back();
        else
            pieces.back() += c;
    }
    for (auto& piece : pieces) {
        std::erase(piece, '"');
        piece = std::string(trimmed(piece));
    }
    return pieces;
}

/// The share that a name such as "dx (10)", "d[v, 0.5]", "x50", "10% d" or "median" stands for.
std::optional<Label> label_of(const std::string& piece) {
    if (piece.empty() || piece.size() > 60) return std::nullopt;
    static const std::regex symbol(R"(^([dx])([xvns]?),?_?(\d{2}(?:\.\d+)?|0?\.\d+)%?(?:,[0-3])?(um|mm|nm|micron)?$)");
    static const std::regex percent(
        R"(^(?:<|(?:.*(?:at|bei|a|diameter|durchmesser)))?(\d{1,2}(?:\.\d+)?)%(?:[dx]|tile|percentile)?(um|mm|nm|micron)?$)");
    static const std::regex median(R"(^(?:median|medianwert|mediansize|mediandiameter|mediand50)(um|mm|nm|micron)?$)");
    std::string plain;
    for (const char c : piece)
        if (std::string_view(" ()[]{}_;").find(c) == std::string_view::npos) plain += c;
    // D[4,3], D[3,2] and D[1,0] are means.
    if (plain.find("d4,3") == 0 || plain.find("d3,2") == 0 || plain.find("d1,0") == 0 || plain.find("d43") == 0 ||
        plain.find("d32") == 0)
        return std::nullopt;
    std::smatch match;
    const auto unit_of = [](const std::string& word) { return word == "micron" ? std::string("um") : word; };
    if (std::regex_match(plain, match, symbol)) {
        std::string digits = match[3];
        if (digits.starts_with('.')) digits.insert(0, "0");
        const double number = number_in(digits).value_or(0);
        const double share = number < 1 ? number : number / 100;
        if (!(share > 0)) return std::nullopt;
        const std::string kind = match[2];
        return Label{share,
                     kind == "n"   ? std::optional<std::string>("number")
                     : kind == "v" ? std::optional<std::string>("volume")
                                   : std::nullopt,
                     unit_of(match[4]), false};
    }
    if (std::regex_match(plain, match, percent)) {
        const double number = number_in(std::string(match[1])).value_or(0);
        const bool bare = plain.find_first_not_of("0123456789.%") == std::string::npos;
        if (number > 0) return Label{number / 100, {}, unit_of(match[2]), bare};
    }
    if (std::regex_match(plain, match, median)) return Label{0.5, {}, unit_of(match[1]), false};
    return std::nullopt;
}

/// A size as a piece gives it, by decimal points and commas; the unit of the piece, else `unit`.
std::vector<double> readings_of(const std::string& piece, const std::string& unit) {
    std::vector<double> sizes;
    for (const bool comma : {false, true})
        if (const auto number = export_number(piece, comma); number && number->value > 0 && number->unit != "%") {
            const auto metres =
                in_si(fmt::format("{} {}", number->value, number->unit.empty() ? unit : number->unit), "m");
            if (const auto* value = std::get_if<double>(&metres);
                value && std::ranges::find(sizes, *value) == sizes.end())
                sizes.push_back(*value);
        }
    return sizes;
}

class Finder {
public:
    Finder(const ExportGrid& grid, std::string unit) : unit_(std::move(unit)) {
        for (const auto& line : grid.around | std::views::take(most_lines))
            if (line.size() <= longest_words) lines_.push_back(pieces_of(line, grid.separator)), raw_.push_back(line);
    }

    std::vector<StatedPercentile> find() {
        for (std::size_t k = 0; k < lines_.size(); ++k) {
            named(k);
            list(k);
            column(k);
            sentence(raw_[k]);
        }
        return std::move(found_);
    }

private:
    void add(double share, const std::string& name, std::vector<double> sizes,
             const std::optional<std::string>& by = {}) {
        const bool known = std::ranges::any_of(
            found_, [&](const auto& one) { return std::abs(one.share - share) < 1e-9 && one.by == by; });
        if (sizes.empty() || known || !(share > 0 && share < 1)) return;
        std::string shown = name;
        if (shown.starts_with('d')) shown.front() = 'D';
        found_.push_back({share, std::move(sizes), std::move(shown), by});
    }
    [[nodiscard]] static std::string unit_behind(const Pieces& pieces, std::size_t at) {
        return at < pieces.size() ? length_unit(pieces[at]) : std::string();
    }

    /// A label, and its size behind it or below it.
    void named(std::size_t k) {
        const auto& pieces = lines_[k];
        std::size_t labels = 0;
        for (const auto& piece : pieces) labels += label_of(piece) ? 1 : 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (const auto label = label_of(pieces[i])) {
                if (label->bare && labels < 2) continue;
                std::vector<double> sizes;
                std::size_t at = i + 1;
                while (at < pieces.size() && pieces[at].empty()) ++at;
                std::string unit = label->unit.empty() ? unit_ : label->unit;
                std::string text;
                for (; at < pieces.size(); ++at) {
                    const auto behind = unit_behind(pieces, at + 1);
                    const auto more = readings_of(pieces[at], behind.empty() ? unit : behind);
                    if (more.empty()) break;
                    sizes.insert(sizes.end(), more.begin(), more.end());
                    if (text.empty()) text = pieces[at] + (behind.empty() ? "" : " " + behind);
                }
                for (std::size_t below = k + 1; sizes.empty() && below < std::min(k + 3, lines_.size()); ++below)
                    if (i < lines_[below].size() && !lines_[below][i].empty()) {
                        sizes = readings_of(lines_[below][i], unit), text = lines_[below][i];
                        break;
                    }
                add(label->share, fmt::format("{} {}", pieces[i], text), sizes, label->by);
                continue;
            }
            // "d10 20.1 um" in one piece
            for (auto blank = pieces[i].rfind(' '); blank != std::string::npos && blank > 0;
                 blank = pieces[i].rfind(' ', blank - 1)) {
                const auto label = label_of(pieces[i].substr(0, blank));
                if (!label || label->bare) continue;
                add(label->share, pieces[i],
                    readings_of(pieces[i].substr(blank + 1), label->unit.empty() ? unit_ : label->unit), label->by);
                break;
            }
        }
    }
    /// "Q3 [%]  10.0  50.0  90.0" over "x [mm]  0,433  0,620  0,888".
    void list(std::size_t k) {
        if (k + 1 >= lines_.size() || lines_[k].size() < 3 || lines_[k + 1].size() < lines_[k].size()) return;
        const auto percents = export_heading(lines_[k].front()), sizes = export_heading(lines_[k + 1].front());
        const bool share = lines_[k].front().starts_with('q') || percents.percentile;
        if (!share || !sizes.size) return;
        for (std::size_t j = 1; j < lines_[k].size(); ++j) {
            const auto percent = export_number(lines_[k][j], lines_[k][j].find(',') != std::string::npos);
            if (percent)
                add(percent->value / 100,
                    fmt::format("{} {} %: {} {}", lines_[k].front(), lines_[k][j], lines_[k + 1].front(),
                                lines_[k + 1][j]),
                    readings_of(lines_[k + 1][j], sizes.length.empty() ? unit_ : sizes.length));
        }
    }
    /// A column of percentiles beside a column of sizes.
    void column(std::size_t k) {
        const auto& heads = lines_[k];
        for (std::size_t i = 0; i + 1 < heads.size(); ++i) {
            const auto first = export_heading(heads[i]), second = export_heading(heads[i + 1]);
            const bool forward = first.percentile && second.size;
            if (!forward && !(second.percentile && first.size)) continue;
            const auto& length = forward ? second.length : first.length;
            for (std::size_t row = k + 1; row < lines_.size() && i + 1 < lines_[row].size(); ++row) {
                const auto& share = lines_[row][forward ? i : i + 1];
                const auto& size = lines_[row][forward ? i + 1 : i];
                const auto percent = export_number(share, share.find(',') != std::string::npos);
                if (!percent) break;
                add(percent->value / 100, fmt::format("{} {}: {}", heads[forward ? i : i + 1], share, size),
                    readings_of(size, length.empty() ? unit_ : length));
            }
            return;
        }
    }
    /// "(2)10.00 (%)- 5.12 (um)", "10.0 % <= 3.21 um".
    void sentence(const std::string& line) {
        static const std::regex form(
            R"((\d+(?:[.,]\d+)?)\s*\(?%\)?\s*(?:-|<=?|:|=)\s*(\d+(?:[.,]\d+)?)\s*\(?(um|mm|nm))");
        std::smatch match;
        if (!std::regex_search(line, match, form)) return;
        std::string percent = match[1];
        std::ranges::replace(percent, ',', '.');
        if (const auto share = number_in(percent))
            add(*share / 100, match[0], readings_of(fmt::format("{} {}", match[2].str(), match[3].str()), unit_));
    }

    std::vector<Pieces> lines_;
    std::vector<std::string> raw_;
    std::string unit_;
    std::vector<StatedPercentile> found_;
};

}  // namespace

std::vector<StatedPercentile> stated_percentiles(const ExportGrid& grid, const std::string& unit) {
    return Finder(grid, unit).find();
}

bool agrees(const ExportCurve& curve, const StatedPercentile& stated) {
    constexpr double rounding_of_size = 0.005, rounding_of_share = 0.005;
    return std::ranges::any_of(stated.sizes, [&](double size) {
        double low = 0, high = 1;  // shares at the edges of the classes that hold the size
        for (std::size_t k = 0; k < curve.sizes.size(); ++k) {
            if (curve.sizes[k] <= size * (1 - rounding_of_size)) low = curve.below[k];
            if (curve.sizes[k] >= size * (1 + rounding_of_size)) {
                high = curve.below[k];
                break;
            }
        }
        return low - rounding_of_share <= stated.share && stated.share <= high + rounding_of_share;
    });
}

}  // namespace grainsweep::campaign
