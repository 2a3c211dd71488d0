// Canvas for lines and texts in points of print (1/72 inch), y downwards: a surface of cairo, or elements of SVG.
#pragma once

#include "sweep/plot/plot.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

struct _cairo;  // cairo_t

namespace grainsweep::plot {

inline constexpr double points_per_mm = 72 / 25.4;
inline constexpr double title_size = 8, label_size = 7, line_height = 1.25;

/// Point of a text that is at the given place.
enum class Anchor { start, middle, end };

class Canvas {
public:
    /// `context` is not owned. `svg` takes what is drawn as elements of SVG; then the context only measures texts.
    explicit Canvas(_cairo* context, std::string* svg = nullptr);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    void use(Colour tone);
    void use(Colour tone, double line_width, bool dashed = false);
    void move_to(double x, double y);
    void line_to(double x, double y);
    void close();
    void segment(double x0, double y0, double x1, double y1);
    void rectangle(double left, double top, double right, double bottom);
    void stroke();
    void fill();
    /// Fills a circle.
    void dot(double x, double y, double radius);
    /// Draws only inside of the rectangle, until `unclip`.
    void clip(double left, double top, double right, double bottom);
    void unclip();

    /// Returns the width of a line of text. Raised digits (m³, 10⁻⁶) are drawn as small digits, which every font has.
    [[nodiscard]] double width(const std::string& text, double size);
    /// Draws a text. `y`: middle of the height of small letters; `turn`: radians, clockwise.
    void text(double x, double y, const std::string& text, double size, Anchor anchor = Anchor::start, double turn = 0);
    /// Returns the text in lines not longer than `length`, broken at spaces.
    [[nodiscard]] std::vector<std::string> wrapped(const std::string& text, double size, double length);

private:
    void add(const std::string& style, std::string_view tag, const std::string& rest);
    void write_pending();

    _cairo* context_;
    std::string* svg_;
    Colour tone_;
    double line_width_ = 1;
    bool dashed_ = false;
    double left_ = 0, top_ = 0;            ///< origin of SVG inside of a clip
    std::string path_ = {};                ///< of SVG
    std::string across_ = {}, down_ = {};  ///< its last point
    std::string style_ = {}, pending_ = {};
    std::size_t tag_ = 0, count_ = 0;  ///< length of the first pending element's name, and number of elements
};

}  // namespace grainsweep::plot
