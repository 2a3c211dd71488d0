#include "sweep/plot/panel.hpp"

#include <cairo.h>

#include "sweep/plot/axes.hpp"
#include "sweep/plot/marks.hpp"

#include <algorithm>
#include <variant>

namespace grainsweep::plot {
namespace {

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
            draw_sign(canvas, left + to / 2, y, Points::Shape::dot, 1.8, key.tone);
            break;
        case diamond:
            draw_sign(canvas, left + to / 2, y, Points::Shape::diamond, 2.5, key.tone);
            break;
        case cross:
            draw_sign(canvas, left + to / 2, y, Points::Shape::cross, 1.8, key.tone);
            break;
    }
    canvas.use(black);
    canvas.text(left + sign_width, y, key.text, label_size);
}

}  // namespace

double room_of_keys(Canvas& canvas, const std::vector<Key>& keys, double width) {
    const auto places = places_of(canvas, keys, width);
    return places.empty() ? 0 : static_cast<double>(places.back().line + 1) * key_line + label_gap;
}

void draw_keys(Canvas& canvas, const std::vector<Key>& keys, double width) {
    const auto places = places_of(canvas, keys, width);
    for (std::size_t k = 0; k < places.size(); ++k)
        draw_key(canvas, keys[k], places[k].left + 1, key_line * (static_cast<double>(places[k].line) + 0.5));
}

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

void draw_panel(Canvas& canvas, const Panel& panel, const std::string& letter, const Box& frame) {
    const PlacedAxis x{panel.x, frame.left, frame.right}, y{panel.y, frame.bottom, frame.top};
    for (const auto& mark : panel.marks) {
        const double beyond = std::holds_alternative<Points>(mark) ? 2.5 : 0;  // a sign at the edge is drawn whole
        cairo_save(canvas.context());
        canvas.rectangle(frame.left - beyond, frame.top - beyond, frame.right + beyond, frame.bottom + beyond);
        cairo_clip(canvas.context());
        draw_mark(canvas, x, y, mark);
        cairo_restore(canvas.context());
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

}  // namespace grainsweep::plot
