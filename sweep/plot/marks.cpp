#include "sweep/plot/marks.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace grainsweep::plot {
namespace {

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
                cairo_line_to(canvas.context(), at->first, at->second);
            else if (at)
                cairo_move_to(canvas.context(), at->first, at->second);
            open = at.has_value();
        }
    }

    void operator()(const Line& line) const {
        canvas.use(line.tone, line.width, line.dashed);
        join(line.x, line.y);
        canvas.stroke();
    }

    /// Stretch by stretch between gaps.
    void operator()(const Band& band) const {
        canvas.use(band.tone);
        for (std::size_t k = 0; k + 1 < band.x.size(); ++k) {
            const auto a = place(band.x[k], band.low[k]), b = place(band.x[k + 1], band.low[k + 1]);
            const auto c = place(band.x[k + 1], band.high[k + 1]), d = place(band.x[k], band.high[k]);
            if (!a || !b || !c || !d) continue;
            cairo_move_to(canvas.context(), a->first, a->second);
            for (const auto& corner : {b, c, d}) cairo_line_to(canvas.context(), corner->first, corner->second);
            cairo_close_path(canvas.context());
        }
        canvas.fill();  // in one piece: neighbours do not darken each other
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
        constexpr double overlap = 0.15;  // no white line between neighbours
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
        for (std::size_t k = 0; k < count; ++k) {
            const auto& tone = points.tones[points.tones.size() == 1 ? 0 : k];
            if (const auto at = place(points.x[k], points.y[k]))
                draw_sign(canvas, at->first, at->second, points.shape, radius, tone);
        }
    }

    void operator()(const Marker& marker) const {
        const auto at = x.place(marker.at);
        if (!at) return;
        canvas.use(black, 0.6, true);
        canvas.segment(*at, y.from, *at, y.to);
        canvas.stroke();
    }
};

}  // namespace

void draw_mark(Canvas& canvas, const PlacedAxis& x, const PlacedAxis& y, const Mark& mark) {
    std::visit(Between{canvas, x, y}, mark);
}

void draw_sign(Canvas& canvas, double x, double y, Points::Shape shape, double radius, Colour tone) {
    auto* context = canvas.context();
    switch (shape) {
        case Points::Shape::dot:
            canvas.use(tone);
            cairo_new_sub_path(context);
            cairo_arc(context, x, y, radius, 0, 2 * std::numbers::pi);
            return canvas.fill();
        case Points::Shape::diamond:
            canvas.use(tone);
            cairo_move_to(context, x, y - radius);
            for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}})
                cairo_line_to(context, x + dx * radius, y + dy * radius);
            return canvas.fill();
        case Points::Shape::cross:
            // White around it, to stand out on every colour.
            for (const auto& [width, colour] : {std::pair{1.8, Colour{1, 1, 1}}, {0.8, tone}}) {
                canvas.use(colour, width);
                for (const int up : {-1, 1}) canvas.segment(x - radius, y - up * radius, x + radius, y + up * radius);
                canvas.stroke();
            }
    }
}

}  // namespace grainsweep::plot
