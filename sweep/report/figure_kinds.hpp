// Catalogue of figures for print, one row each; callers use figures.hpp.
#pragma once

#include "sweep/report/figures.hpp"
#include "sweep/report/print_axes.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

using PanelNames = std::vector<std::string>;

/// Options of a figure: across and up, colour, axis, lines.
struct FigureOptions {
    bool choice = false, colour = false, axis = false, lines = false;
};

struct FigureKind {
    std::string_view name, shows;
    /// Returns the names of the panels; {""}: a single one; empty: the campaign has no such figure.
    PanelNames (*panels)(const FigureSubject& subject);
    /// Returns these panels with their names.
    plot::Figure (*draw)(const FigureSubject& subject, const PanelNames& panels);
    OnPage place = OnPage::response;
    FigureOptions has = {};
};

// Rows, by file.
extern const FigureKind distribution_figure;  // response_figures.cpp
extern const FigureKind convergence_figure;
extern const FigureKind effects_figure;
extern const FigureKind sensitivity_figure;  // influence_figures.cpp
extern const FigureKind variance_figure;
extern const FigureKind model_figure;  // model_figures.cpp
extern const FigureKind model_map_figure;
extern const FigureKind cases_figure;  // case_figures.cpp
extern const FigureKind map_figure;
extern const FigureKind against_figure;
extern const FigureKind curves_figure;     // curve_figures.cpp
extern const FigureKind posterior_figure;  // posterior_figures.cpp

/// Width of figures on a page, and by `figure` without --width, in mm.
inline constexpr double figure_width_mm = 85;
/// Returns the figure without bytes that are no UTF-8 and without control characters in its texts.
[[nodiscard]] plot::Figure drawable(plot::Figure figure);

[[nodiscard]] study::History history_of(const FigureSubject& subject);
[[nodiscard]] study::Influence influence_of(const FigureSubject& subject);
/// Returns the names of the varied factors.
[[nodiscard]] PanelNames factor_panels(const FigureSubject& subject);
[[nodiscard]] const study::FactorColumn& factor_named(const FigureSubject& subject, std::string_view name);
/// Returns whether the response has values.
[[nodiscard]] bool has_values(const FigureSubject& subject);
/// Return a single panel, or one per varied factor, if the response has values.
[[nodiscard]] PanelNames panel_of_values(const FigureSubject& subject);
[[nodiscard]] PanelNames panels_of_factors(const FigureSubject& subject);
/// Returns the factors by their share of the response's variance, the most influential first.
[[nodiscard]] std::vector<const study::FactorColumn*> by_influence(const FigureSubject& subject);
/// Returns the variable that an option names: factor, response or "point". Throws InputError with the nearest name.
[[nodiscard]] Variable named_variable(const FigureSubject& subject, std::string_view option, const std::string& name);

/// Returns whether the axis of the response is logarithmic, over this range. Throws InputError where that is
/// requested and the range is not positive.
[[nodiscard]] bool has_log_axis(const FigureSubject& subject, const NumberRange& range);
/// Returns the response as a variable, with the requested axis.
[[nodiscard]] Variable response_variable(const FigureSubject& subject);

/// Most failed cases that a figure shows.
inline constexpr std::size_t most_crosses = 500;
/// Returns the rows of failed cases, at most `most_crosses` at random.
[[nodiscard]] std::vector<std::size_t> failed_rows(const study::Responses& responses);
/// Return crosses, and their entry of the legend.
[[nodiscard]] plot::Points crosses(std::vector<double> x, std::vector<double> y);
[[nodiscard]] plot::Key failed_key();
/// Colour scale for numbers of a quantity, with its axis.
struct ColourScale {
    plot::Axis axis;
    [[nodiscard]] plot::Colour of(double shown) const;
};
[[nodiscard]] ColourScale colour_scale(const Quantity& quantity, const NumberRange& range, bool log = false);

}  // namespace grainsweep::report
