// Panels of predictions: a response against one factor with its bands, and a map over two factors.
#pragma once

#include "sweep/report/model_page.hpp"
#include "sweep/report/print_axes.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace grainsweep::report {

struct ColourScale;

/// Returns a curve with its bands, of words a dot with whiskers each, and crosses for failed cases at the lower edge.
/// A part of the curve that has no numbers is not drawn.
[[nodiscard]] plot::Panel curve_panel(const study::ModelCases& cases, std::size_t factor, const ModelCurve& curve,
                                      const Quantity& up, const plot::Axis& up_axis);
/// Returns the entries of the legend for panels with these parts.
[[nodiscard]] std::vector<plot::Key> curve_keys(const study::ModelCases& cases, const ModelCurve& curve);

/// Returns cells in the colours of a scale, with crosses for failed cases. NaN: an empty cell.
[[nodiscard]] plot::Panel cells_panel(const study::ModelCases& cases, const MapPlace& map,
                                      const std::vector<double>& values, const Quantity& shown,
                                      const ColourScale& scale);
/// Adds a line around the cells that are `inside`, one per cell.
void enclose(plot::Panel& panel, const std::vector<bool>& inside);

/// Returns where the axis of a model's factor has this number: a level that is a number at its index.
[[nodiscard]] double place_on_axis(const study::ModelFactor& factor, double number);

}  // namespace grainsweep::report
