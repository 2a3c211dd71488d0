// Panels side by side on paper, and the paper as a file.
#include "sweep/files/system_error.hpp"
#include "sweep/plot/axes.hpp"
#include "sweep/plot/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

namespace grainsweep::plot {
namespace {

// ---- marks of a panel

void outline_sign(Canvas& canvas, double x, double y, Points::Shape shape, double radius) {
    if (shape == Points::Shape::cross) {
        for (const int up : {-1, 1}) canvas.segment(x - radius, y - up * radius, x + radius, y + up * radius);
        return;
    }
    constexpr int corners = 32;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners;
        const double across = x + radius * std::cos(angle), down = y + radius * std::sin(angle);
        k == 0 ? canvas.move_to(across, down) : canvas.line_to(across, down);
    }
    canvas.close();
}

/// Draws the signs of Points. `tones`: one for each sign, or one for all.
void draw_signs(Canvas& canvas, const std::vector<std::pair<double, double>>& places, Points::Shape shape,
                double radius, const std::vector<Colour>& tones) {
    using enum Points::Shape;
    if (shape == cross || shape == ring) {
        // White around them, to stand out on every colour.
        for (const auto& [width, tone] : {std::pair{1.8, Colour{1, 1, 1}}, {0.8, tones.front()}}) {
            canvas.use(tone, width);
            for (const auto& [x, y] : places) outline_sign(canvas, x, y, shape, radius);
            canvas.stroke();
        }
        return;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto& [x, y] = places[k];
        canvas.use(tones[tones.size() == 1 ? 0 : k]);
        if (shape == dot) {
            canvas.dot(x, y, radius);
            continue;
        }
        canvas.move_to(x, y - radius);
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}})
            canvas.line_to(x + dx * radius, y + dy * radius);
        canvas.fill();
    }
}

/// The two axes of a panel, and a canvas.
struct Between {
    Canvas& canvas;
    const PlacedAxis& x;
    const PlacedAxis& y;

    [[nodiscard]] std::optional<std::pair<double, double>> place(double across, double up) const {
        const auto a = x.place(across), b = y.place(up);
        if (!a || !b) return std::nullopt;
        return std::pair(*a, *b);
    }

    /// Joins the places; a place that cannot be drawn leaves a gap.
    void join(const std::vector<double>& xs, const std::vector<double>& ys) const {
        bool open = false;
        for (std::size_t k = 0; k < xs.size(); ++k) {
            const auto at = place(xs[k], ys[k]);
            if (at && open)
                canvas.line_to(at->first, at->second);
            else if (at)
                canvas.move_to(at->first, at->second);
            open = at.has_value();
        }
    }

    void operator()(const Line& line) const {
        canvas.use(line.tone, line.width, line.dashed);
        join(line.x, line.y);
        canvas.stroke();
    }

    /// Stretch by stretch between gaps: along the lower edge, and back along the upper one.
    void operator()(const Band& band) const {
        canvas.use(band.tone);
        std::vector<std::pair<double, double>> low, high;
        const auto end_stretch = [&] {
            low.insert(low.end(), high.rbegin(), high.rend());
            for (std::size_t k = 0; high.size() > 1 && k < low.size(); ++k)
                k == 0 ? canvas.move_to(low[k].first, low[k].second) : canvas.line_to(low[k].first, low[k].second);
            if (high.size() > 1) canvas.close();
            low.clear();
            high.clear();
        };
        for (std::size_t k = 0; k < band.x.size(); ++k) {
            const auto under = place(band.x[k], band.low[k]), over = place(band.x[k], band.high[k]);
            if (!under || !over) {
                end_stretch();
                continue;
            }
            low.push_back(*under);
            high.push_back(*over);
        }
        end_stretch();
        canvas.fill();
    }

    void operator()(const Whiskers& whiskers) const {
        constexpr double cap = 1.5;
        canvas.use(whiskers.tone, 0.6, whiskers.dashed);
        for (std::size_t k = 0; k < whiskers.at.size(); ++k) {
            const double low = whiskers.value[k] - whiskers.half_width[k];
            const double high = whiskers.value[k] + whiskers.half_width[k];
            const auto a = whiskers.across ? place(low, whiskers.at[k]) : place(whiskers.at[k], low);
            const auto b = whiskers.across ? place(high, whiskers.at[k]) : place(whiskers.at[k], high);
            if (!a || !b || !(high > low)) continue;
            const double dx = whiskers.across ? 0 : cap, dy = whiskers.across ? cap : 0;
            canvas.segment(a->first, a->second, b->first, b->second);
            for (const auto& end : {*a, *b})
                canvas.segment(end.first - dx, end.second - dy, end.first + dx, end.second + dy);
        }
        canvas.stroke();
    }

    void operator()(const Bars& bars) const {
        canvas.use(bars.tone);
        for (std::size_t k = 0; k < bars.from.size(); ++k) {
            const auto a = bars.across ? place(0, bars.from[k]) : place(bars.from[k], 0);
            const auto b = bars.across ? place(bars.length[k], bars.to[k]) : place(bars.to[k], bars.length[k]);
            if (a && b) canvas.rectangle(a->first, a->second, b->first, b->second);
        }
        canvas.fill();
    }

    void operator()(const Cells& cells) const {
        const std::size_t columns = cells.x_edges.size() - 1;
        constexpr double overlap = 0.35;  // no white line between neighbours
        for (std::size_t k = 0; k < cells.tones.size(); ++k) {
            if (!cells.tones[k]) continue;
            const auto a = place(cells.x_edges[k % columns], cells.y_edges[k / columns + 1]);
            const auto b = place(cells.x_edges[k % columns + 1], cells.y_edges[k / columns]);
            if (!a || !b) continue;
            canvas.use(*cells.tones[k]);
            canvas.rectangle(a->first, a->second - overlap, b->first + overlap, b->second);
            canvas.fill();
        }
    }

    void operator()(const Points& points) const {
        const auto count = points.x.size();
        const double radius = points.radius.value_or(count > 1000 ? 0.8 : count > 200 ? 1.1 : 1.5);
        const bool alike = points.tones.size() == 1;
        std::vector<std::pair<double, double>> places;
        std::vector<Colour> tones;
        for (std::size_t k = 0; k < count; ++k)
            if (const auto at = place(points.x[k], points.y[k])) {
                places.push_back(*at);
                if (!alike || tones.empty()) tones.push_back(points.tones[alike ? 0 : k]);
            }
        if (!places.empty()) draw_signs(canvas, places, points.shape, radius, tones);
    }

    void operator()(const Marker& marker) const {
        const auto at = x.place(marker.at);
        if (!at) return;
        canvas.use(black, 0.6, true);
        canvas.segment(*at, y.from, *at, y.to);
        canvas.stroke();
    }
};

// ---- panel in its place (margins, marks, frame), and the legend above all panels

/// Margins around the frame of a panel, in points of print.
struct Margins {
    double left = 0, right = 0, top = 0, bottom = 0;
};

struct Box {
    double left = 0, top = 0, right = 0, bottom = 0;
};

constexpr double paper_edge = 1.5;  // nothing is drawn nearer to it
constexpr double sign_width = 12, key_gap = 9, key_line = line_height * label_size;

/// Position of a key: number of its line from the top, and distance from the left.
struct KeyPlace {
    std::size_t line = 0;
    double left = 0;
};

/// Side by side, in as many lines as the width makes them take.
std::vector<KeyPlace> places_of(Canvas& canvas, const std::vector<Key>& keys, double width) {
    std::vector<KeyPlace> places;
    KeyPlace next;
    for (const auto& key : keys) {
        const double needs = sign_width + canvas.width(key.text, label_size);
        if (next.left > 0 && next.left + needs > width) next = {next.line + 1, 0};
        places.push_back(next);
        next.left += needs + key_gap;
    }
    return places;
}

void draw_key(Canvas& canvas, const Key& key, double left, double y) {
    constexpr double to = sign_width - 4;
    using enum Key::Kind;
    switch (key.kind) {
        case area:
            canvas.use(key.tone);
            canvas.rectangle(left, y - 2.2, left + to, y + 2.2);
            canvas.fill();
            break;
        case Key::Kind::line:
        case dashes:
            canvas.use(key.tone, 1, key.kind == dashes);
            canvas.segment(left, y, left + to, y);
            canvas.stroke();
            break;
        case dot:
            draw_signs(canvas, {{left + to / 2, y}}, Points::Shape::dot, 1.8, {key.tone});
            break;
        case diamond:
            draw_signs(canvas, {{left + to / 2, y}}, Points::Shape::diamond, 2.5, {key.tone});
            break;
        case cross:
            draw_signs(canvas, {{left + to / 2, y}}, Points::Shape::cross, 1.8, {key.tone});
            break;
    }
    canvas.use(black);
    canvas.text(left + sign_width, y, key.text, label_size);
}

/// Returns the height of a legend, 0 without keys.
double room_of_keys(Canvas& canvas, const std::vector<Key>& keys, double width) {
    const auto places = places_of(canvas, keys, width);
    return places.empty() ? 0 : static_cast<double>(places.back().line + 1) * key_line + label_gap;
}

/// Draws the legend at the top of the paper.
void draw_keys(Canvas& canvas, const std::vector<Key>& keys, double width) {
    const auto places = places_of(canvas, keys, width);
    for (std::size_t k = 0; k < places.size(); ++k)
        draw_key(canvas, keys[k], places[k].left + 1, key_line * (static_cast<double>(places[k].line) + 0.5));
}

/// Returns the margins of a panel of this size for titles and labels; `lettered`: and for "(a)" above it.
Margins margins_of(Canvas& canvas, const Panel& panel, bool lettered, double width, double height) {
    Margins margins;
    // The labels' room follows from the frame and the frame from that room: three rounds settle it.
    for (int round = 0; round < 3; ++round) {
        const double inner_height = std::max(20.0, height - margins.top - margins.bottom);
        margins.left = paper_edge + room_left(canvas, panel.y, inner_height);
        margins.right = panel.scale ? paper_edge + room_of_scale(canvas, *panel.scale, inner_height) : label_size;
        const double inner_width = std::max(20.0, width - margins.left - margins.right);
        margins.bottom = paper_edge + room_below(canvas, panel.x, inner_width);
        margins.top = lettered ? line_height * title_size + label_gap : label_size / 2;
    }
    return margins;
}

/// Draws the panel with its frame at the box. `letter`: "(a)", or empty.
void draw_panel(Canvas& canvas, const Panel& panel, const std::string& letter, const Box& frame) {
    const PlacedAxis x{panel.x, frame.left, frame.right}, y{panel.y, frame.bottom, frame.top};
    for (const auto& mark : panel.marks) {
        const double beyond = std::holds_alternative<Points>(mark) ? 2.5 : 0;  // a sign at the edge is drawn whole
        canvas.clip(frame.left - beyond, frame.top - beyond, frame.right + beyond, frame.bottom + beyond);
        std::visit(Between{canvas, x, y}, mark);
        canvas.unclip();
    }
    canvas.use(black, frame_width);
    canvas.rectangle(frame.left, frame.top, frame.right, frame.bottom);
    canvas.stroke();
    draw_below(canvas, x, frame.bottom);
    draw_left(canvas, y, frame.left);
    if (panel.scale) draw_scale(canvas, {*panel.scale, frame.bottom, frame.top}, frame.right);
    canvas.use(black);
    canvas.text(frame.left, frame.top - label_gap - title_size / 2, letter, title_size);
}

// ---- figure

constexpr double narrowest_mm = 38, narrowest_with_scale_mm = 60, tallest_mm = 90, gap_mm = 3;
constexpr double dots_per_inch = 600;

struct Free {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Free>;
using Context = std::unique_ptr<cairo_t, Free>;

void require_drawn(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS)
        throw SystemError(fmt::format("the figure cannot be drawn: {}", cairo_status_to_string(status)));
}

/// Rows of panels of one width, below a legend.
struct Layout {
    std::size_t columns = 1, rows = 1;
    double width = 0, height = 0, gap = gap_mm * points_per_mm;  ///< of a panel, in points of print
    double legend = 0;                                           ///< its height

    [[nodiscard]] double total_height() const {
        return legend + static_cast<double>(rows) * height + static_cast<double>(rows - 1) * gap;
    }
    [[nodiscard]] Box box(std::size_t k) const {
        const double left = static_cast<double>(k % columns) * (width + gap);
        const double top = legend + static_cast<double>(k / columns) * (height + gap);
        return {left, top, left + width, top + height};
    }
};

Layout layout_of(const Figure& figure, double width_mm) {
    const auto count = figure.panels.size();
    const bool scales = std::ranges::any_of(figure.panels, [](const Panel& panel) { return panel.scale.has_value(); });
    const double narrowest = scales ? narrowest_with_scale_mm : narrowest_mm;
    Layout layout;
    const auto fit = static_cast<std::size_t>((width_mm + gap_mm) / (narrowest + gap_mm));
    layout.columns = std::clamp<std::size_t>(fit, 1, count);
    layout.rows = (count + layout.columns - 1) / layout.columns;
    const double columns = static_cast<double>(layout.columns);
    const double panel_mm = (width_mm - (columns - 1) * gap_mm) / columns;
    double height_mm = std::min(tallest_mm, panel_mm * (panel_mm < 60 ? 0.95 : 0.7));
    for (const auto& panel : figure.panels) height_mm = panel.height_mm.value_or(height_mm);
    layout.width = panel_mm * points_per_mm;
    layout.height = height_mm * points_per_mm;
    const Surface nowhere(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
    const Context context(cairo_create(nowhere.get()));
    Canvas canvas(context.get());
    layout.legend = room_of_keys(canvas, figure.keys, width_mm * points_per_mm);
    return layout;
}

/// The frames of all panels are equally large: margins are the widest of any.
void draw(cairo_t* context, const Figure& figure, const Layout& layout, std::string* svg = nullptr) {
    Canvas canvas(context, svg);
    std::vector<std::string> letters(figure.panels.size());
    if (letters.size() > 1)
        for (std::size_t k = 0; k < letters.size(); ++k)
            letters[k] = k < 26 ? fmt::format("({})", static_cast<char>('a' + k)) : fmt::format("({})", k + 1);
    Margins widest;
    for (std::size_t k = 0; k < letters.size(); ++k) {
        const auto margins = margins_of(canvas, figure.panels[k], letters.size() > 1, layout.width, layout.height);
        widest = {std::max(widest.left, margins.left), std::max(widest.right, margins.right),
                  std::max(widest.top, margins.top), std::max(widest.bottom, margins.bottom)};
    }
    draw_keys(canvas, figure.keys, layout.box(layout.columns - 1).right);
    for (std::size_t k = 0; k < letters.size(); ++k) {
        const auto box = layout.box(k);
        draw_panel(
            canvas, figure.panels[k], letters[k],
            {box.left + widest.left, box.top + widest.top, box.right - widest.right, box.bottom - widest.bottom});
    }
    require_drawn(cairo_status(context));
}

cairo_status_t collect_bytes(void* bytes, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

/// Adds the number of pixels per metre to a PNG (W3C, Portable Network Graphics, 11.3.5.3), so that it opens at its
/// width.
std::string with_resolution(const std::string& png) {
    constexpr std::size_t end_of_header = 33;  // signature and IHDR
    const auto big_endian = [](std::uint32_t word) {
        std::string bytes;
        for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(word >> shift & 0xFFU);
        return bytes;
    };
    const auto per_metre = static_cast<std::uint32_t>(std::lround(dots_per_inch / 0.0254));
    const std::string chunk = "pHYs" + big_endian(per_metre) + big_endian(per_metre) + '\x01';
    const auto* bytes = reinterpret_cast<const Bytef*>(chunk.data());
    const auto sum = static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(chunk.size())));
    const std::string whole = big_endian(static_cast<std::uint32_t>(chunk.size() - 4)) + chunk + big_endian(sum);
    return std::string(png).insert(end_of_header, whole);
}

std::string as_png(const Figure& figure, const Layout& layout, double width) {
    constexpr double scale = dots_per_inch / 72;
    const auto pixels = [](double points) { return static_cast<int>(std::lround(points * scale)); };
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(layout.total_height())));
    const Context context(cairo_create(surface.get()));
    cairo_set_source_rgb(context.get(), 1, 1, 1);
    cairo_paint(context.get());
    cairo_scale(context.get(), scale, scale);
    draw(context.get(), figure, layout);
    std::string bytes;
    require_drawn(cairo_surface_write_to_png_stream(surface.get(), collect_bytes, &bytes));
    return with_resolution(bytes);
}

std::string as_pdf(const Figure& figure, const Layout& layout, double width) {
    std::string bytes;
    const Surface surface(cairo_pdf_surface_create_for_stream(collect_bytes, &bytes, width, layout.total_height()));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    {
        const Context context(cairo_create(surface.get()));
        draw(context.get(), figure, layout);
    }
    cairo_surface_finish(surface.get());
    require_drawn(cairo_surface_status(surface.get()));
    return bytes;
}

/// Texts stay texts. No element has an id, so that a page can hold many figures.
std::string as_svg(const Figure& figure, const Layout& layout, double width) {
    const Surface nowhere(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
    const Context context(cairo_create(nowhere.get()));
    std::string elements;
    draw(context.get(), figure, layout, &elements);
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.2f}pt\" "
        "height=\"{1:.2f}pt\" viewBox=\"0 0 {0:.2f} {1:.2f}\" stroke-linejoin=\"round\" "
        "font-family=\"'Liberation Sans', Arial, Helvetica, sans-serif\">\n{2}</svg>\n",
        width, layout.total_height(), elements);
}

}  // namespace

std::string drawn(const Figure& figure, double width_mm, FileType type) {
    const auto layout = layout_of(figure, width_mm);
    const double width = width_mm * points_per_mm;
    switch (type) {
        case FileType::pdf:
            return as_pdf(figure, layout, width);
        case FileType::svg:
            return as_svg(figure, layout, width);
        case FileType::png:
            break;
    }
    return as_png(figure, layout, width);
}

}  // namespace grainsweep::plot
