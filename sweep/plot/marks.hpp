// Drawing of the marks of a panel.
#pragma once

#include "sweep/plot/axes.hpp"

namespace grainsweep::plot {

void draw_mark(Canvas& canvas, const PlacedAxis& x, const PlacedAxis& y, const Mark& mark);
/// Draws a sign of Points.
void draw_sign(Canvas& canvas, double x, double y, Points::Shape shape, double radius, Colour tone);

}  // namespace grainsweep::plot
