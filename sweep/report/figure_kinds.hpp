// The catalogue of figures for print, one row each; figures.hpp has what callers need.
#pragma once

#include "sweep/report/figures.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/study/influence.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

using PanelNames = std::vector<std::string>;

struct FigureKind {
    std::string_view name, shows;
    /// Names of the panels; {""}: a single one; empty: the campaign has no such figure.
    PanelNames (*panels)(const FigureSubject& subject);
    plot::Figure (*draw)(const FigureSubject& subject, const PanelNames& panels);
    bool has_choice = false;  ///< takes across, up
    bool has_colour = false;  ///< takes colour
};

// Rows, by file.
[[nodiscard]] FigureKind distribution_figure();  // response_figures.cpp
[[nodiscard]] FigureKind convergence_figure();
[[nodiscard]] FigureKind effects_figure();
[[nodiscard]] FigureKind sensitivity_figure();  // influence_figures.cpp
[[nodiscard]] FigureKind variance_figure();
[[nodiscard]] FigureKind model_figure();  // model_figures.cpp
[[nodiscard]] FigureKind model_map_figure();
[[nodiscard]] FigureKind cases_figure();  // case_figures.cpp
[[nodiscard]] FigureKind map_figure();
[[nodiscard]] FigureKind against_figure();
[[nodiscard]] FigureKind curves_figure();     // curve_figures.cpp
[[nodiscard]] FigureKind posterior_figure();  // posterior_figures.cpp

/// Names of the factors that vary.
[[nodiscard]] PanelNames factor_panels(const FigureSubject& subject);
[[nodiscard]] const study::FactorColumn& factor_named(const FigureSubject& subject, std::string_view name);
/// Whether values of the response count.
[[nodiscard]] bool has_values(const FigureSubject& subject);
/// Factors by what they explain of the response, the most influential first.
[[nodiscard]] std::vector<const study::FactorColumn*> by_influence(const FigureSubject& subject);
/// A variable that the options name: factor, response or "point". Throws WrongQuestion with the nearest name.
[[nodiscard]] Variable named_variable(const FigureSubject& subject, std::string_view option, const std::string& name);

/// Rows of cases that failed.
[[nodiscard]] std::vector<std::size_t> failed_rows(const study::Responses& responses);
/// Crosses, and their line of the legend.
[[nodiscard]] plot::Points crosses(std::vector<double> x, std::vector<double> y);
[[nodiscard]] plot::Key failed_key();
/// Colours along a scale for numbers of a quantity, and the axis of the scale.
struct ColourScale {
    plot::Axis axis;
    [[nodiscard]] plot::Colour of(double shown) const;
};
[[nodiscard]] ColourScale colour_scale(const Quantity& quantity, const NumberRange& range, bool log = false);

}  // namespace grainsweep::report
