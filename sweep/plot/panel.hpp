// Drawing of a panel in its place (margins, marks, frame), and of the legend above all panels.
#pragma once

#include "sweep/plot/canvas.hpp"

#include <string>

namespace grainsweep::plot {

/// Margins around the frame of a panel, in points of print.
struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;
};
struct Box {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// Returns the margins of a panel of this size for titles and labels; `lettered`: and for "(a)" above it.
[[nodiscard]] Margins margins_of(Canvas& canvas, const Panel& panel, bool lettered, double width, double height);
/// Draws the panel with its frame at the box. `letter`: "(a)", or empty.
void draw_panel(Canvas& canvas, const Panel& panel, const std::string& letter, const Box& frame);

/// Returns the height of a legend, 0 without keys; the next function draws it at the top of the paper.
[[nodiscard]] double room_of_keys(Canvas& canvas, const std::vector<Key>& keys, double width);
void draw_keys(Canvas& canvas, const std::vector<Key>& keys, double width);

}  // namespace grainsweep::plot
