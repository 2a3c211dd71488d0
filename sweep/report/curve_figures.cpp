// curves: series and profiles, a line per case.
#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/curves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

/// "distance from the wall (m)": the unit stands behind the words.
Quantity quantity_of_words(const std::string& words, const NumberRange& range) {
    const auto open = words.rfind(" (");
    if (open == std::string::npos || !words.ends_with(')')) return quantity_of(words, "1", 1.0);
    return quantity_of(words.substr(0, open), words.substr(open + 2, words.size() - open - 3), range);
}

/// Bins in a geometric series belong on a logarithmic axis: their last step is as large, relatively, as their first.
bool geometric(std::vector<double> places) {
    std::ranges::sort(places);
    const auto [end, last] = std::ranges::unique(places);
    places.erase(end, last);
    if (places.size() < 4 || places.front() <= 0) return false;
    const auto step = [&](std::size_t k) { return std::log(places[k + 1] / places[k]); };
    return std::abs(step(0) / step(places.size() - 2) - 1) < 0.1;
}

plot::Panel family_panel(const CurveFamily& family, const Variable& by, const std::optional<ColourScale>& scale) {
    std::vector<double> xs, ys;
    for (const auto& curve : family.curves) {
        xs.insert(xs.end(), curve.x.begin(), curve.x.end());
        ys.insert(ys.end(), curve.y.begin(), curve.y.end());
    }
    const auto x_range = finite_range(xs), y_range = finite_range(ys);
    const auto across = quantity_of_words(family.over, x_range);
    const auto up = quantity_of(family.name, family.unit, y_range);
    plot::Panel panel{number_axis(across, x_range, family.over_bins && geometric(xs), 0), number_axis(up, y_range)};
    for (const auto& curve : family.curves) {
        const double value = by.values[curve.row];
        const auto tone = scale ? scale->of(by.quantity().of(value)) : plot::category(static_cast<std::size_t>(value));
        auto x = across.of(curve.x), y = up.of(curve.y);
        if (x.size() == 1)
            panel.marks.push_back(plot::Points{std::move(x), std::move(y), {tone}});
        else
            panel.marks.push_back(plot::Line{std::move(x), std::move(y), tone, 0.7});
    }
    if (scale) panel.scale = scale->axis;
    panel.name = family.name;
    return panel;
}

plot::Figure draw_curves(const FigureSubject& subject, const PanelNames& panels) {
    const auto curves = read_curves(subject.store, subject.responses);
    const std::string name = !subject.colour.empty() ? subject.colour : by_influence(subject).front()->name;
    const auto by = named_variable(subject, "--colour", name);
    std::optional<ColourScale> scale;
    if (by.levels.empty()) scale = colour_scale(by.quantity(), {by.low, by.high}, by.log);
    plot::Figure figure;
    for (const auto& family : curves.families)
        if (std::ranges::count(panels, family.name) > 0) figure.panels.push_back(family_panel(family, by, scale));
    figure.keys = by.keys(plot::Key::Kind::line);
    return figure;
}

PanelNames curves_panels(const FigureSubject& subject) {
    PanelNames names;
    if (subject.responses.factors.empty()) return names;
    for (const auto& family : read_curves(subject.store, subject.responses).families)
        if (!family.curves.empty()) names.push_back(family.name);
    return names;
}

}  // namespace

constinit const FigureKind curves_figure{
    "curves", "series and profiles, a line per case", curves_panels, draw_curves, OnPage::script, {.colour = true}};

}  // namespace grainsweep::report
