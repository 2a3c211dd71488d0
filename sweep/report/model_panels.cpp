#include "sweep/report/model_panels.hpp"

#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/box_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

std::vector<double> places_on_axis(const ModelFactor& factor, const std::vector<double>& numbers) {
    std::vector<double> places;
    for (const double x : numbers) places.push_back(place_on_axis(factor, x));
    return places;
}

/// The places of some failed cases on the axis of one factor.
std::vector<double> failed_places(const ModelCases& cases, std::size_t factor) {
    std::vector<std::size_t> rows(cases.failed.size());
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = k;
    std::vector<double> numbers;
    for (const auto k : random_rows(std::move(rows), most_crosses)) numbers.push_back(cases.failed[k].setting[factor]);
    return places_on_axis(cases.factors[factor], numbers);
}

/// Edges of the cells on the axis of a factor.
std::vector<double> edges_on_axis(const ModelFactor& factor, std::size_t count) {
    const auto variable = variable_of(factor);
    if (variable.levels.empty()) return variable.quantity().of(cell_edges(factor, count));
    std::vector<double> edges;  // levels stand at 0, 1, ...
    for (std::size_t k = 0; k <= variable.levels.size(); ++k) edges.push_back(static_cast<double>(k) - 0.5);
    return edges;
}

}  // namespace

double place_on_axis(const ModelFactor& factor, double number) {
    if (factor.is_word() || std::isnan(number)) return number;
    if (factor.numbers.empty()) return variable_of(factor).quantity().of(number);
    return static_cast<double>(std::ranges::find(factor.numbers, number) - factor.numbers.begin());
}

plot::Panel curve_panel(const ModelCases& cases, std::size_t j, const ModelCurve& curve, const Quantity& up,
                        const plot::Axis& up_axis) {
    const auto& factor = cases.factors[j];
    const auto x = places_on_axis(factor, curve.at);
    const auto mean = up.of(curve.mean), averaged = up.of(curve.averaged);
    const auto beside = [&](double sign, const std::vector<double>& width) {
        std::vector<double> y;
        for (std::size_t i = 0; i < x.size(); ++i) y.push_back(up.of(curve.mean[i] + sign * width[i]));
        return y;
    };
    const bool banded = !curve.mean_half_width.empty(), words = factor.is_word();  // nothing lies between two words
    plot::Panel panel{variable_of(factor).axis(0), up_axis};
    panel.name = factor.name;
    auto& marks = panel.marks;
    using enum plot::Points::Shape;
    if (words && banded) {
        marks = {plot::Whiskers{x, mean, up.of(curve.run_half_width), plot::blue, false, true},
                 plot::Whiskers{x, mean, up.of(curve.mean_half_width), plot::blue}};
    } else if (banded) {
        marks = {plot::Band{x, beside(-1, curve.mean_half_width), beside(1, curve.mean_half_width)},
                 plot::Line{x, beside(-1, curve.run_half_width), plot::blue, 0.6, true},
                 plot::Line{x, beside(1, curve.run_half_width), plot::blue, 0.6, true}};
    }
    if (words) {
        if (!averaged.empty()) marks.push_back(plot::Points{x, averaged, {plot::vermilion}, diamond, 2.5});
        marks.push_back(plot::Points{x, mean, {plot::blue}, dot, 1.8});
    } else {
        if (!averaged.empty()) marks.push_back(plot::Line{x, averaged, plot::vermilion});
        marks.push_back(plot::Line{x, mean});
    }
    if (auto failed = failed_places(cases, j); !failed.empty()) {
        std::vector<double> low(failed.size(), up_axis.low);
        marks.push_back(crosses(std::move(failed), std::move(low)));
    }
    return panel;
}

std::vector<plot::Key> curve_keys(const ModelCases& cases, const ModelCurve& curve) {
    using enum plot::Key::Kind;
    std::vector<plot::Key> keys;
    if (!curve.averaged.empty()) keys = {{"other factors at mid-range", plot::blue, line}};
    if (!curve.mean_half_width.empty())
        keys.insert(keys.end(), {{"95 % of the mean", plot::faded(plot::blue, 0.2), area},
                                 {"95 % of a single run", plot::blue, dashes}});
    if (!curve.averaged.empty()) keys.push_back({"average over the other factors", plot::vermilion, line});
    if (!cases.failed.empty()) keys.push_back(failed_key());
    return keys;
}

plot::Panel cells_panel(const ModelCases& cases, const MapPlace& map, const std::vector<double>& values,
                        const Quantity& shown, const ColourScale& scale) {
    const auto &a = cases.factors[map.across], &b = cases.factors[map.up];
    plot::Cells cells{edges_on_axis(a, map.count), edges_on_axis(b, map.count), {}};
    for (const double x : values)
        cells.tones.push_back(std::isfinite(x) ? std::optional(scale.of(shown.of(x))) : std::nullopt);
    plot::Panel panel{variable_of(a).axis(0), variable_of(b).axis(0), {std::move(cells)}, scale.axis};
    if (!cases.failed.empty())
        panel.marks.push_back(crosses(failed_places(cases, map.across), failed_places(cases, map.up)));
    return panel;
}

void enclose(plot::Panel& panel, const std::vector<bool>& inside) {
    const auto& cells = std::get<plot::Cells>(panel.marks.front());
    const auto &x = cells.x_edges, &y = cells.y_edges;
    const std::size_t columns = x.size() - 1, rows = y.size() - 1;
    constexpr double gap = std::numeric_limits<double>::quiet_NaN();
    plot::Line edge{{}, {}, plot::black, 1.2};
    const auto add = [&](double x0, double y0, double x1, double y1) {
        edge.x.insert(edge.x.end(), {x0, x1, gap});
        edge.y.insert(edge.y.end(), {y0, y1, gap});
    };
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
            const bool here = inside[j * columns + i];
            if (i + 1 < columns && inside[j * columns + i + 1] != here) add(x[i + 1], y[j], x[i + 1], y[j + 1]);
            if (j + 1 < rows && inside[(j + 1) * columns + i] != here) add(x[i], y[j + 1], x[i + 1], y[j + 1]);
        }
    panel.marks.insert(panel.marks.begin() + 1, std::move(edge));
}

}  // namespace grainsweep::report
