// Figure for print as data: panels with axes and marks, independent of the origin of the numbers. Numbers are already
// in the unit of the title.
#pragma once

#include "sweep/plot/colours.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::plot {

/// Axis from `low` at the left or lower end to `high`; low > high reverses it.
struct Axis {
    std::string title = {};
    double low = 0, high = 1;
    bool log = false;                     ///< both ends are positive
    std::vector<std::string> words = {};  ///< words at 0, 1, ...; empty: numbers
};
/// Returns an axis of words, each in the middle of its interval.
[[nodiscard]] inline Axis axis_of_words(std::string title, std::vector<std::string> words) {
    const double high = static_cast<double>(words.size()) - 0.5;
    return {std::move(title), -0.5, high, false, std::move(words)};
}

/// Points of one colour, or with one colour each.
struct Points {
    enum class Shape { dot, diamond, cross, ring };
    std::vector<double> x, y;
    std::vector<Colour> tones = {blue};
    Shape shape = Shape::dot;
    std::optional<double> radius = {};  ///< in points of print; empty: by their number
};
/// Line, broken at NaN.
struct Line {
    std::vector<double> x, y;
    Colour tone = blue;
    double width = 1;  ///< in points of print
    bool dashed = false;
};
struct Band {
    std::vector<double> x, low, high;
    Colour tone = faded(blue, 0.2);
};
/// Whiskers from value - half_width to value + half_width at `at`; none for NaN.
struct Whiskers {
    std::vector<double> at, value, half_width;
    Colour tone = black;
    bool across = false;  ///< the values are on the horizontal axis
    bool dashed = false;
};
/// Bars from 0 to `length` between the edges.
struct Bars {
    std::vector<double> from, to, length;
    Colour tone = blue;
    bool across = false;
};
/// Rectangles; `y` varies slowest.
struct Cells {
    std::vector<double> x_edges, y_edges;
    std::vector<std::optional<Colour>> tones;
};
/// Dashed vertical line.
struct Marker {
    double at = 0;
};
using Mark = std::variant<Cells, Band, Bars, Line, Whiskers, Points, Marker>;

/// Entry of the legend, drawn like its mark.
struct Key {
    enum class Kind { area, line, dashes, dot, diamond, cross };
    std::string text;
    Colour tone = blue;
    Kind kind = Kind::dot;
};

struct Panel {
    Axis x, y;
    std::vector<Mark> marks = {};
    std::optional<Axis> scale = {};        ///< colour bar at the right
    std::optional<double> height_mm = {};  ///< empty: from its width
    std::string name = {};                 ///< among the panels of its figure; not drawn
};

struct Figure {
    std::vector<Panel> panels;
    std::vector<Key> keys = {};  ///< of all panels, above them
};

/// File types of a figure, the extension of a file.
enum class FileType { pdf, svg, png };
[[nodiscard]] inline std::optional<FileType> file_type(std::string_view file_name) {
    if (file_name.ends_with(".pdf")) return FileType::pdf;
    if (file_name.ends_with(".svg")) return FileType::svg;
    if (file_name.ends_with(".png")) return FileType::png;
    return std::nullopt;
}

/// Returns the bytes of the file. At any width text is 7 to 8 points high and lines are 0.5 to 1 point wide; panels are
/// side by side if there is room. PNG has 600 dots per inch. The same figure gives the same bytes on one machine,
/// because the file has no date. Throws SystemError if the library cannot draw.
[[nodiscard]] std::string drawn(const Figure& figure, double width_mm, FileType type);

}  // namespace grainsweep::plot
