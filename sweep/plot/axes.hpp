// An axis in its place on the canvas: where a number stands, which ticks have room, what room they need.
#pragma once

#include "sweep/plot/canvas.hpp"
#include "sweep/plot/ticks.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::plot {

inline constexpr double tick_length = 2.5, label_gap = 2, frame_width = 0.5;

/// From `from` at the axis' low end to `to` at its high one, in points of print.
struct PlacedAxis {
    const Axis& axis;
    double from = 0, to = 1;

    /// None where the axis has no such place: what is not finite, and 0 or less on a logarithmic axis.
    [[nodiscard]] std::optional<double> place(double x) const;
    [[nodiscard]] double length() const;
};

/// What stands at an axis: `slanted` where words lie at an angle, because side by side they would overlap.
struct AxisLabels {
    std::vector<Tick> ticks;
    bool slanted = false;
    double widest = 0;  ///< of the labels

    /// Room of the labels and ticks across the axis.
    [[nodiscard]] double depth(bool upright) const;
};
/// As many labels as stand side by side without touching. `upright`: of a vertical axis.
[[nodiscard]] AxisLabels labels_of(Canvas& canvas, const PlacedAxis& placed, bool upright);

/// Ticks, labels and title of the axis below a panel, from its lower edge on; and left of one.
void draw_below(Canvas& canvas, const PlacedAxis& placed, double edge);
void draw_left(Canvas& canvas, const PlacedAxis& placed, double edge);
/// A bar of colours right of a panel, with its ticks and title.
void draw_scale(Canvas& canvas, const PlacedAxis& placed, double left);

/// Room that they take: of a title as many lines as `length` makes it have.
[[nodiscard]] double room_below(Canvas& canvas, const Axis& axis, double length);
[[nodiscard]] double room_left(Canvas& canvas, const Axis& axis, double length);
[[nodiscard]] double room_of_scale(Canvas& canvas, const Axis& axis, double length);

}  // namespace grainsweep::plot
