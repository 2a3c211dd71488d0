// Axis in its place on the canvas: places of numbers, ticks that fit, and the room that they need.
#pragma once

#include "sweep/plot/canvas.hpp"
#include "sweep/plot/ticks.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::plot {

inline constexpr double tick_length = 2.5, label_gap = 2, frame_width = 0.5;

/// Axis from `from` at its low end to `to` at its high end, in points of print.
struct PlacedAxis {
    const Axis& axis;
    double from = 0, to = 1;

    /// Returns the place of a number; empty if it is not finite, or 0 or less on a logarithmic axis.
    [[nodiscard]] std::optional<double> place(double x) const;
    [[nodiscard]] double length() const;
};

/// Labels of an axis. `slanted`: words are drawn at an angle, because they would overlap side by side.
struct AxisLabels {
    std::vector<Tick> ticks;
    bool slanted = false;
    double widest = 0;  ///< width of the widest label

    /// Returns the room of labels and ticks across the axis.
    [[nodiscard]] double depth(bool upright) const;
};
/// Returns as many labels as fit side by side. `upright`: vertical axis.
[[nodiscard]] AxisLabels labels_of(Canvas& canvas, const PlacedAxis& placed, bool upright);

/// Draw ticks, labels and title of the axis below a panel, from its lower edge on, or left of it.
void draw_below(Canvas& canvas, const PlacedAxis& placed, double edge);
void draw_left(Canvas& canvas, const PlacedAxis& placed, double edge);
/// Draws a colour bar right of a panel, with ticks and title.
void draw_scale(Canvas& canvas, const PlacedAxis& placed, double left);

/// Return the room that they need, with the title wrapped to `length`.
[[nodiscard]] double room_below(Canvas& canvas, const Axis& axis, double length);
[[nodiscard]] double room_left(Canvas& canvas, const Axis& axis, double length);
[[nodiscard]] double room_of_scale(Canvas& canvas, const Axis& axis, double length);

}  // namespace grainsweep::plot
