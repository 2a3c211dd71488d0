// model, model-map: predictions of a response model between the cases.
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/figure_kinds.hpp"
#include "sweep/report/model_panels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

/// Returns the model of the caller, or fits one.
std::shared_ptr<const Modelled> modelled(const FigureSubject& subject) {
    if (subject.modelled) return subject.modelled;
    auto cases = settled_and_imported_cases(subject.responses);
    const auto model = learn_or_refuse(cases, cases.observable(subject.response.name));
    auto pictures = model_pictures(cases, model, admission(subject.store, cases));
    return std::make_shared<const Modelled>(std::move(cases), std::move(pictures));
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

plot::Figure draw_model(const FigureSubject& subject, const PanelNames& panels) {
    const auto found = modelled(subject);
    const auto& [cases, pictures] = *found;
    const auto range = range_of_curves(pictures);
    const auto up = quantity_of(subject.response.name, subject.response.unit, range);
    const auto axis = number_axis(up, range, has_log_axis(subject, range));
    plot::Figure figure;
    for (const auto j : pictures.order)
        if (std::ranges::count(panels, cases.factors[j].name) > 0)
            figure.panels.push_back(curve_panel(cases, j, pictures.curves[j], up, axis));
    figure.keys = curve_keys(cases, pictures.curves.front());
    return figure;
}

plot::Figure draw_model_map(const FigureSubject& subject, const PanelNames& panels) {
    const auto found = modelled(subject);
    const auto& [cases, pictures] = *found;
    const auto& map = *pictures.map;
    plot::Figure figure;
    auto numbers = map.averaged;
    numbers.insert(numbers.end(), map.slice.begin(), map.slice.end());
    const auto range = finite_range(numbers);
    const auto shown = quantity_of(subject.response.name, subject.response.unit, range);
    const auto scale = colour_scale(shown, range, has_log_axis(subject, range));
    for (const auto& [name, values] : {std::pair("averaged", &map.averaged), {"mid-range", &map.slice}})
        if (std::ranges::count(panels, name) > 0) {
            figure.panels.push_back(cells_panel(cases, map, *values, shown, scale));
            figure.panels.back().name = name;
        }
    if (!cases.failed.empty()) figure.keys = {failed_key()};
    return figure;
}

/// Panels do not need a fitted model. If a model is refused, drawing its figure reports the reason.
PanelNames model_map_panels(const FigureSubject& subject) {
    if (!has_values(subject) || subject.responses.factors.size() < 2) return {};
    return subject.responses.factors.size() == 2 ? PanelNames{"averaged"} : PanelNames{"averaged", "mid-range"};
}

}  // namespace

constinit const FigureKind model_figure{"model",           "response model against each factor, with 95 % bands",
                                        panels_of_factors, draw_model,
                                        OnPage::model,     {.axis = true}};

constinit const FigureKind model_map_figure{
    "model-map",      "response model over the two most influential factors; the others averaged, or at mid-range",
    model_map_panels, draw_model_map,
    OnPage::model,    {.axis = true}};

}  // namespace grainsweep::report
