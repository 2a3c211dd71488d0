#include "sweep/plot/axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::plot {
namespace {

constexpr double slant = -std::numbers::pi / 5;  // of words that do not fit side by side
constexpr double bar_gap = 6, bar_width = 7;
constexpr double title_line = line_height * title_size;

std::vector<Tick> words_of(const Axis& axis, std::size_t every) {
    std::vector<Tick> ticks;
    for (std::size_t k = 0; k < axis.words.size(); k += every) ticks.push_back({static_cast<double>(k), axis.words[k]});
    return ticks;
}

/// Returns every second tick; zero is kept if it is a tick.
std::vector<Tick> every_second(const std::vector<Tick>& ticks) {
    std::vector<Tick> kept;
    const auto zero = std::ranges::find_if(ticks, [](const Tick& tick) { return std::abs(tick.at) < 1e-300; });
    const auto start = zero == ticks.end() ? 0 : (zero - ticks.begin()) % 2;
    for (auto k = static_cast<std::size_t>(start); k < ticks.size(); k += 2) kept.push_back(ticks[k]);
    return kept;
}

/// Returns whether neighbouring labels keep a distance. size(label): length of a label along the axis.
template <class Size>
bool stand_apart(const PlacedAxis& placed, const std::vector<Tick>& ticks, double distance, Size size) {
    for (std::size_t k = 1; k < ticks.size(); ++k) {
        const auto a = placed.place(ticks[k - 1].at), b = placed.place(ticks[k].at);
        if (a && b && std::abs(*b - *a) < (size(ticks[k - 1]) + size(ticks[k])) / 2 + distance) return false;
    }
    return true;
}

double titled_depth(Canvas& canvas, const Axis& axis, double length) {
    const auto lines = canvas.wrapped(axis.title, title_size, length).size();
    return axis.title.empty() ? 0 : static_cast<double>(lines) * title_line + label_gap;
}

}  // namespace

std::optional<double> PlacedAxis::place(double x) const {
    if (!std::isfinite(x) || (axis.log && x <= 0)) return std::nullopt;
    const auto at = [&](double value) { return axis.log ? std::log(value) : value; };
    return from + (to - from) * (at(x) - at(axis.low)) / (at(axis.high) - at(axis.low));
}

double PlacedAxis::length() const {
    return std::abs(to - from);
}

double AxisLabels::depth(bool upright) const {
    const double along = upright ? widest : label_size;
    const double turned = widest * std::sin(-slant) + label_size * std::cos(slant);
    return tick_length + label_gap + (slanted ? turned : along);
}

AxisLabels labels_of(Canvas& canvas, const PlacedAxis& placed, bool upright) {
    const auto& axis = placed.axis;
    const auto width = [&](const Tick& tick) { return canvas.width(tick.label, label_size); };
    const auto height = [](const Tick&) { return label_size; };
    AxisLabels labels;
    const auto apart = [&] {
        return upright ? stand_apart(placed, labels.ticks, 1, height) : stand_apart(placed, labels.ticks, 4, width);
    };
    if (!axis.words.empty()) {
        labels.ticks = words_of(axis, 1);
        labels.slanted = !upright && !apart();
        for (std::size_t every = 2; (upright || labels.slanted) && !stand_apart(placed, labels.ticks, 1, height);
             ++every)
            labels.ticks = words_of(axis, every);
    } else {
        for (int most = upright ? 6 : 7; most >= 1; --most) {
            labels.ticks = ticks_of(axis, most);
            if (apart()) break;
            labels.ticks = every_second(labels.ticks);
            if (labels.ticks.size() > 1 && apart()) break;
        }
    }
    for (const auto& tick : labels.ticks) labels.widest = std::max(labels.widest, width(tick));
    return labels;
}

void draw_below(Canvas& canvas, const PlacedAxis& placed, double edge) {
    const auto labels = labels_of(canvas, placed, false);
    canvas.use(black, frame_width);
    for (const auto& tick : labels.ticks)
        if (const auto x = placed.place(tick.at)) canvas.segment(*x, edge, *x, edge + tick_length);
    for (const double minor : minor_ticks(placed.axis))
        if (const auto x = placed.place(minor)) canvas.segment(*x, edge, *x, edge + tick_length / 2);
    canvas.stroke();
    const double y = edge + tick_length + label_gap + label_size / 2;
    for (const auto& tick : labels.ticks) {
        const auto x = placed.place(tick.at);
        if (!x) continue;
        if (labels.slanted)
            canvas.text(*x + label_size / 3, y - label_size / 4, tick.label, label_size, Anchor::end, slant);
        else
            canvas.text(*x, y, tick.label, label_size, Anchor::middle);
    }
    double below = edge + labels.depth(false) + label_gap + title_line / 2;
    for (const auto& text : canvas.wrapped(placed.axis.title, title_size, placed.length())) {
        canvas.text((placed.from + placed.to) / 2, below, text, title_size, Anchor::middle);
        below += title_line;
    }
}

void draw_left(Canvas& canvas, const PlacedAxis& placed, double edge) {
    const auto labels = labels_of(canvas, placed, true);
    canvas.use(black, frame_width);
    for (const auto& tick : labels.ticks)
        if (const auto y = placed.place(tick.at)) canvas.segment(edge, *y, edge - tick_length, *y);
    for (const double minor : minor_ticks(placed.axis))
        if (const auto y = placed.place(minor)) canvas.segment(edge, *y, edge - tick_length / 2, *y);
    canvas.stroke();
    for (const auto& tick : labels.ticks)
        if (const auto y = placed.place(tick.at))
            canvas.text(edge - tick_length - label_gap, *y, tick.label, label_size, Anchor::end);
    auto lines = canvas.wrapped(placed.axis.title, title_size, placed.length());
    double left = edge - labels.depth(true) - label_gap - title_line * (static_cast<double>(lines.size()) - 0.5);
    for (const auto& text : lines) {
        canvas.text(left, (placed.from + placed.to) / 2, text, title_size, Anchor::middle, -std::numbers::pi / 2);
        left += title_line;
    }
}

void draw_scale(Canvas& canvas, const PlacedAxis& placed, double edge) {
    constexpr int steps = 128;
    const double left = edge + bar_gap, right = left + bar_width;
    for (int k = 0; k < steps; ++k) {
        const double low = placed.from + (placed.to - placed.from) * k / steps;
        // Each step reaches to the end: no gap shows where edges are smoothed.
        canvas.use(along_scale((k + 0.5) / steps));
        canvas.rectangle(left, placed.to, right, low);
        canvas.fill();
    }
    const auto labels = labels_of(canvas, placed, true);
    canvas.use(black, frame_width);
    canvas.rectangle(left, placed.to, right, placed.from);
    for (const auto& tick : labels.ticks)
        if (const auto y = placed.place(tick.at)) canvas.segment(right, *y, right + tick_length, *y);
    canvas.stroke();
    for (const auto& tick : labels.ticks)
        if (const auto y = placed.place(tick.at))
            canvas.text(right + tick_length + label_gap, *y, tick.label, label_size);
    double at = right + labels.depth(true) + label_gap + title_line / 2;
    for (const auto& text : canvas.wrapped(placed.axis.title, title_size, placed.length())) {
        canvas.text(at, (placed.from + placed.to) / 2, text, title_size, Anchor::middle, -std::numbers::pi / 2);
        at += title_line;
    }
}

double room_below(Canvas& canvas, const Axis& axis, double length) {
    return labels_of(canvas, {axis, 0, length}, false).depth(false) + titled_depth(canvas, axis, length);
}

double room_left(Canvas& canvas, const Axis& axis, double length) {
    return labels_of(canvas, {axis, 0, length}, true).depth(true) + titled_depth(canvas, axis, length);
}

double room_of_scale(Canvas& canvas, const Axis& axis, double length) {
    return bar_gap + bar_width + room_left(canvas, axis, length);
}

}  // namespace grainsweep::plot
