// model, model-map: predictions of a response model between the cases.
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/figure_kinds.hpp"
#include "sweep/report/model_page.hpp"
#include "sweep/study/factor_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

/// The model of the response and its pictures.
struct Modelled {
    ModelCases cases;
    ModelPictures pictures;
};

Modelled modelled(const FigureSubject& subject) {
    auto cases = settled_and_imported_cases(subject.responses);
    const auto model = learn_or_refuse(cases, cases.observable(subject.response.name));
    auto pictures = model_pictures(cases, model, admission(subject.store, cases));
    return {std::move(cases), std::move(pictures)};
}

/// Where a model's factor places a number: of levels that are numbers, the index of the level.
std::vector<double> placed(const ModelFactor& factor, const Quantity& across, const std::vector<double>& numbers) {
    if (factor.is_word()) return numbers;
    if (factor.numbers.empty()) return across.of(numbers);
    std::vector<double> places;
    for (const double x : numbers)
        places.push_back(static_cast<double>(std::ranges::find(factor.numbers, x) - factor.numbers.begin()));
    return places;
}

/// The numbers of one factor in the failed cases.
std::vector<double> failed_numbers(const ModelCases& cases, std::size_t factor) {
    std::vector<double> numbers;
    for (const auto& failed : cases.failed) numbers.push_back(failed.setting[factor]);
    return numbers;
}

NumberRange range_of_curves(const ModelPictures& pictures) {
    std::vector<double> ends;
    for (const auto& curve : pictures.curves)
        for (std::size_t i = 0; i < curve.at.size(); ++i) {
            ends.push_back(curve.averaged[i]);
            for (const double sign : {-1.0, 1.0}) ends.push_back(curve.mean[i] + sign * curve.run_half_width[i]);
        }
    return finite_range(ends);
}

plot::Panel model_panel(const Modelled& modelled, std::size_t j, const Quantity& up, const plot::Axis& up_axis) {
    const auto& factor = modelled.cases.factors[j];
    const auto& curve = modelled.pictures.curves[j];
    const auto variable = variable_of(factor);
    const auto x = placed(factor, variable.quantity(), curve.at);
    const auto beside = [&](double sign, const std::vector<double>& width) {
        std::vector<double> y;
        for (std::size_t i = 0; i < x.size(); ++i) y.push_back(up.of(curve.mean[i] + sign * width[i]));
        return y;
    };
    plot::Panel panel{variable.axis(0), up_axis};
    if (factor.is_word()) {  // nothing lies between two words
        using enum plot::Points::Shape;
        panel.marks = {plot::Whiskers{x, up.of(curve.mean), up.of(curve.run_half_width), plot::blue, false, true},
                       plot::Whiskers{x, up.of(curve.mean), up.of(curve.mean_half_width), plot::blue},
                       plot::Points{x, up.of(curve.averaged), {plot::vermilion}, diamond, 2.5},
                       plot::Points{x, up.of(curve.mean), {plot::blue}, dot, 1.8}};
    } else {
        panel.marks = {plot::Band{x, beside(-1, curve.mean_half_width), beside(1, curve.mean_half_width)},
                       plot::Line{x, beside(-1, curve.run_half_width), plot::blue, 0.6, true},
                       plot::Line{x, beside(1, curve.run_half_width), plot::blue, 0.6, true},
                       plot::Line{x, up.of(curve.averaged), plot::vermilion}, plot::Line{x, up.of(curve.mean)}};
    }
    const auto failed = placed(factor, variable.quantity(), failed_numbers(modelled.cases, j));
    if (!failed.empty()) panel.marks.push_back(crosses(failed, std::vector(failed.size(), up_axis.low)));
    return panel;
}

plot::Figure draw_model(const FigureSubject& subject, const PanelNames& panels) {
    const auto found = modelled(subject);
    const auto range = range_of_curves(found.pictures);
    const auto up =
        quantity_of(subject.response.name, subject.response.unit, std::max(std::abs(range.low), std::abs(range.high)));
    plot::Figure figure;
    for (const auto j : found.pictures.order)
        if (std::ranges::count(panels, found.cases.factors[j].name) > 0)
            figure.panels.push_back(model_panel(found, j, up, number_axis(up, range, has_log_axis(subject, range))));
    using enum plot::Key::Kind;
    figure.keys = {{"other factors at mid-range", plot::blue, line},
                   {"95 % of the mean", plot::faded(plot::blue, 0.2), area},
                   {"95 % of a single run", plot::blue, dashes},
                   {"average over the other factors", plot::vermilion, line}};
    if (!found.cases.failed.empty()) figure.keys.push_back(failed_key());
    return figure;
}

plot::Panel model_map_panel(const Modelled& modelled, const std::vector<double>& values, const Quantity& shown,
                            const ColourScale& scale) {
    const auto& map = *modelled.pictures.map;
    const auto &a = modelled.cases.factors[map.across], &b = modelled.cases.factors[map.up];
    const auto across = variable_of(a), up = variable_of(b);
    const auto edges = [&](const ModelFactor& factor, const Variable& variable) {
        auto numbers = cell_edges(factor, map.count);
        if (variable.levels.empty()) return variable.quantity().of(numbers);
        numbers.clear();  // levels stand at 0, 1, ...
        for (std::size_t k = 0; k <= variable.levels.size(); ++k) numbers.push_back(static_cast<double>(k) - 0.5);
        return numbers;
    };
    plot::Cells cells{edges(a, across), edges(b, up), {}};
    for (const double x : values)
        cells.tones.push_back(std::isfinite(x) ? std::optional(scale.of(shown.of(x))) : std::nullopt);
    plot::Panel panel{across.axis(0), up.axis(0), {std::move(cells)}, scale.axis};
    if (!modelled.cases.failed.empty())
        panel.marks.push_back(crosses(placed(a, across.quantity(), failed_numbers(modelled.cases, map.across)),
                                      placed(b, up.quantity(), failed_numbers(modelled.cases, map.up))));
    return panel;
}

plot::Figure draw_model_map(const FigureSubject& subject, const PanelNames& panels) {
    const auto found = modelled(subject);
    const auto& map = *found.pictures.map;
    plot::Figure figure;
    auto numbers = map.averaged;
    numbers.insert(numbers.end(), map.slice.begin(), map.slice.end());
    const auto range = finite_range(numbers);
    const auto shown =
        quantity_of(subject.response.name, subject.response.unit, std::max(std::abs(range.low), std::abs(range.high)));
    const auto scale = colour_scale(shown, range, has_log_axis(subject, range));
    for (const auto& [name, values] : {std::pair("averaged", &map.averaged), {"mid-range", &map.slice}})
        if (std::ranges::count(panels, name) > 0)
            figure.panels.push_back(model_map_panel(found, *values, shown, scale));
    if (!found.cases.failed.empty()) figure.keys = {failed_key()};
    return figure;
}

/// Returns the panels without fitting a model. If a model is refused, drawing its figure reports the reason.
PanelNames model_panels(const FigureSubject& subject) {
    return has_values(subject) ? factor_panels(subject) : PanelNames{};
}

PanelNames model_map_panels(const FigureSubject& subject) {
    if (!has_values(subject) || subject.responses.factors.size() < 2) return {};
    return subject.responses.factors.size() == 2 ? PanelNames{"averaged"} : PanelNames{"averaged", "mid-range"};
}

}  // namespace

FigureKind model_figure() {
    return {"model", "response model against each factor, with 95 % bands", model_panels, draw_model, false, false,
            true};
}

FigureKind model_map_figure() {
    return {"model-map",
            "response model over the two most influential factors; the others averaged, or at mid-range",
            model_map_panels,
            draw_model_map,
            false,
            false,
            true};
}

}  // namespace grainsweep::report
