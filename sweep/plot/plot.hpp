// A figure for print as data: panels with axes, and what is drawn in them. Nothing here depends on the origin of the
// numbers. Numbers are as the axes show them, already in the unit of the title.
//
// Colours: Okabe & Ito, "Color Universal Design" (2008), which readers with any colour vision tell apart; scales of
// colours are viridis (van der Walt & Smith 2015), whose lightness grows evenly, so that it survives a grey print.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::plot {

struct Colour {
    double red = 0, green = 0, blue = 0, alpha = 1;
};
inline constexpr Colour black{0, 0, 0}, blue{0, 0.447, 0.698}, vermilion{0.835, 0.369, 0}, grey{0.6, 0.6, 0.6};

/// Of a category: eight different colours, then the same again.
[[nodiscard]] Colour category(std::size_t k);
/// Along viridis: 0 dark blue, 1 yellow.
[[nodiscard]] Colour along_scale(double share);
[[nodiscard]] inline Colour faded(Colour tone, double alpha) {
    tone.alpha = alpha;
    return tone;
}

/// From `low` at the left or lower end to `high`; low > high turns it round.
struct Axis {
    std::string title = {};
    double low = 0, high = 1;
    bool log = false;                     ///< both ends are positive
    std::vector<std::string> words = {};  ///< stand at 0, 1, ...; empty: numbers
};
/// An axis of words, each in the middle of its stretch.
[[nodiscard]] Axis axis_of_words(std::string title, std::vector<std::string> words);

/// Marks of one colour or, where there are several, one for each.
struct Points {
    enum class Shape { dot, diamond, cross };
    std::vector<double> x, y;
    std::vector<Colour> tones = {blue};
    Shape shape = Shape::dot;
    std::optional<double> radius = {};  ///< in points of print; none: by their number
};
/// Broken where a number is NaN.
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
/// value - half_width to value + half_width at `at`; none where a number is NaN.
struct Whiskers {
    std::vector<double> at, value, half_width;
    Colour tone = black;
    bool across = false;  ///< values along the horizontal axis
    bool dashed = false;
};
/// From 0 to `length` between the edges.
struct Bars {
    std::vector<double> from, to, length;
    Colour tone = blue;
    bool across = false;
};
/// Rectangles; `y` goes slowest.
struct Cells {
    std::vector<double> x_edges, y_edges;
    std::vector<std::optional<Colour>> tones;
};
/// A dashed vertical line.
struct Marker {
    double at = 0;
};
using Mark = std::variant<Cells, Band, Bars, Line, Whiskers, Points, Marker>;

/// A line of the legend, drawn as the mark is.
struct Key {
    enum class Kind { area, line, dashes, dot, diamond, cross };
    std::string text;
    Colour tone = blue;
    Kind kind = Kind::dot;
};

struct Panel {
    Axis x, y;
    std::vector<Mark> marks = {};
    std::optional<Axis> scale = {};        ///< of colours, a bar at the right
    std::optional<double> height_mm = {};  ///< none: from its width
};

struct Figure {
    std::vector<Panel> panels;
    std::vector<Key> keys = {};  ///< of all panels, above them
};

/// The files a figure can be: the end of a file's name.
enum class FileType { pdf, svg, png };
[[nodiscard]] std::optional<FileType> file_type(std::string_view file_name);

/// Returns the bytes of the file. Text is 7 to 8 points high and lines 0.5 to 1 point wide at this width, whatever it
/// is; panels stand side by side where there is room. PNG has 600 points an inch. The same figure gives the same bytes
/// on one machine: the file holds no date. Throws BrokenWorld where the library cannot draw.
[[nodiscard]] std::string drawn(const Figure& figure, double width_mm, FileType type);

}  // namespace grainsweep::plot
