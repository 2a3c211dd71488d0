// Canvas for lines and texts in points of print (1/72 inch), y downwards.
#pragma once

#include "sweep/plot/plot.hpp"

#include <string>
#include <vector>

struct _cairo;  // cairo_t

namespace grainsweep::plot {

inline constexpr double points_per_mm = 72 / 25.4;
inline constexpr double title_size = 8, label_size = 7, line_height = 1.25;

/// Point of a text that is at the given place.
enum class Anchor { start, middle, end };

class Canvas {
public:
    /// `context` is not owned.
    explicit Canvas(_cairo* context);

    [[nodiscard]] _cairo* context() const { return context_; }
    void use(Colour tone);
    void use(Colour tone, double line_width, bool dashed = false);
    void segment(double x0, double y0, double x1, double y1);
    void rectangle(double left, double top, double right, double bottom);
    void stroke();
    void fill();

    /// Returns the width of a line of text. Raised digits (m³, 10⁻⁶) are drawn as small digits, which every font has.
    [[nodiscard]] double width(const std::string& text, double size);
    /// Draws a text. `y`: middle of the height of small letters; `turn`: radians, clockwise.
    void text(double x, double y, const std::string& text, double size, Anchor anchor = Anchor::start, double turn = 0);
    /// Returns the text in lines not longer than `length`, broken at spaces.
    [[nodiscard]] std::vector<std::string> wrapped(const std::string& text, double size, double length);

private:
    _cairo* context_;
};

}  // namespace grainsweep::plot
