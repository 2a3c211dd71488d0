// One panel in its place: margins, marks, frame; and the legend above all panels.
#pragma once

#include "sweep/plot/canvas.hpp"

#include <string>

namespace grainsweep::plot {

/// Around the frame of a panel, in points of print.
struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;
};
struct Box {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// What a panel of this size needs around its frame for titles and labels; `lettered`: and for "(a)" above it.
[[nodiscard]] Margins margins_of(Canvas& canvas, const Panel& panel, bool lettered, double width, double height);
/// Draws the panel with its frame in the box and everything else around it. `letter`: "(a)", or empty.
void draw_panel(Canvas& canvas, const Panel& panel, const std::string& letter, const Box& frame);

/// The height of a legend, 0 without keys; and the legend at the top of the paper.
[[nodiscard]] double room_of_keys(Canvas& canvas, const std::vector<Key>& keys, double width);
void draw_keys(Canvas& canvas, const std::vector<Key>& keys, double width);

}  // namespace grainsweep::plot
