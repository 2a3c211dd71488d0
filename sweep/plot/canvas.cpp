#include "sweep/plot/canvas.hpp"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace grainsweep::plot {
namespace {

constexpr double raised_size = 0.72, raised_by = 0.34;

/// A stretch of a text, raised or not.
struct Run {
    std::string text;
    bool raised = false;
};

std::vector<Run> runs_of(const std::string& text) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 11> small = {{{"⁰", "0"},
                                                                                             {"¹", "1"},
                                                                                             {"²", "2"},
                                                                                             {"³", "3"},
                                                                                             {"⁴", "4"},
                                                                                             {"⁵", "5"},
                                                                                             {"⁶", "6"},
                                                                                             {"⁷", "7"},
                                                                                             {"⁸", "8"},
                                                                                             {"⁹", "9"},
                                                                                             {"⁻", "\xE2\x88\x92"}}};
    std::vector<Run> runs;
    const auto add = [&](std::string_view piece, bool raised) {
        if (runs.empty() || runs.back().raised != raised) runs.push_back({{}, raised});
        runs.back().text += piece;
    };
    for (std::size_t at = 0; at < text.size();) {
        const auto rest = std::string_view(text).substr(at);
        bool found = false;
        for (const auto& [digit, plain] : small)
            if (rest.starts_with(digit)) {
                add(plain, true);
                at += digit.size();
                found = true;
                break;
            }
        if (!found) add(rest.substr(0, 1), false), ++at;
    }
    return runs;
}

/// Returns a number for SVG, to a hundredth of a point.
std::string svg_number(double x) {
    auto text = fmt::format("{:.2f}", x);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string svg_colour(std::string_view kind, const Colour& tone) {
    const auto byte = [](double part) { return static_cast<int>(std::lround(255 * part)); };
    auto text = fmt::format("{}=\"#{:02x}{:02x}{:02x}\"", kind, byte(tone.red), byte(tone.green), byte(tone.blue));
    if (tone.alpha < 1) text += fmt::format(" {}-opacity=\"{}\"", kind, svg_number(tone.alpha));
    return text;
}

std::string svg_text(std::string_view text) {
    std::string safe;
    for (const char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return safe;
}

}  // namespace

Canvas::Canvas(cairo_t* context, std::string* svg) : context_(context), svg_(svg) {
    cairo_select_font_face(context_, "Liberation Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_font_options_t* options = cairo_font_options_create();
    // The same widths in every file type.
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(context_, options);
    cairo_font_options_destroy(options);
    cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
}

Canvas::~Canvas() {
    write_pending();
}

/// Neighbours of one style share a group.
void Canvas::add(const std::string& style, std::string_view tag, const std::string& rest) {
    if (style != style_) write_pending();
    if (count_++ == 0) style_ = style, tag_ = tag.size();
    pending_ += fmt::format("<{}{}\n", tag, rest);
}

void Canvas::write_pending() {
    if (count_ == 1) *svg_ += pending_.insert(1 + tag_, " " + style_);
    if (count_ > 1) *svg_ += fmt::format("<g {}>\n{}</g>\n", style_, pending_);
    pending_.clear();
    count_ = 0;
}

void Canvas::use(Colour tone) {
    tone_ = tone;
    cairo_set_source_rgba(context_, tone.red, tone.green, tone.blue, tone.alpha);
}

void Canvas::use(Colour tone, double line_width, bool dashed) {
    use(tone);
    line_width_ = line_width;
    dashed_ = dashed;
    cairo_set_line_width(context_, line_width);
    constexpr std::array<double, 2> dashes = {3, 2};
    cairo_set_dash(context_, dashes.data(), dashed ? 2 : 0, 0);
}

void Canvas::move_to(double x, double y) {
    if (svg_ == nullptr) return cairo_move_to(context_, x, y);
    across_ = svg_number(x - left_), down_ = svg_number(y - top_);
    path_ += fmt::format("M{} {}", across_, down_);
}

void Canvas::line_to(double x, double y) {
    if (svg_ == nullptr) return cairo_line_to(context_, x, y);
    const auto across = svg_number(x - left_), down = svg_number(y - top_);
    path_ += across == across_ ? "V" + down : down == down_ ? "H" + across : fmt::format("L{} {}", across, down);
    across_ = across, down_ = down;
}

void Canvas::close() {
    if (svg_ == nullptr) return cairo_close_path(context_);
    path_ += 'z';
}

void Canvas::segment(double x0, double y0, double x1, double y1) {
    move_to(x0, y0);
    line_to(x1, y1);
}

void Canvas::rectangle(double left, double top, double right, double bottom) {
    if (svg_ == nullptr) return cairo_rectangle(context_, left, top, right - left, bottom - top);
    move_to(left, top);
    path_ += fmt::format("H{}V{}H{}z", svg_number(right - left_), svg_number(bottom - top_), svg_number(left - left_));
}

void Canvas::stroke() {
    if (svg_ == nullptr) return cairo_stroke(context_);
    const auto style = fmt::format("fill=\"none\" {} stroke-width=\"{}\"{}", svg_colour("stroke", tone_),
                                   svg_number(line_width_), dashed_ ? " stroke-dasharray=\"3 2\"" : "");
    if (!path_.empty()) add(style, "path", fmt::format(" d=\"{}\"/>", std::exchange(path_, {})));
}

void Canvas::fill() {
    if (svg_ == nullptr) return cairo_fill(context_);
    if (!path_.empty()) add(svg_colour("fill", tone_), "path", fmt::format(" d=\"{}\"/>", std::exchange(path_, {})));
}

void Canvas::dot(double x, double y, double radius) {
    if (svg_ != nullptr)
        return add(svg_colour("fill", tone_), "circle",
                   fmt::format(" cx=\"{}\" cy=\"{}\" r=\"{}\"/>", svg_number(x - left_), svg_number(y - top_),
                               svg_number(radius)));
    cairo_new_sub_path(context_);
    cairo_arc(context_, x, y, radius, 0, 2 * std::numbers::pi);
    cairo_fill(context_);
}

void Canvas::clip(double left, double top, double right, double bottom) {
    if (svg_ == nullptr) {
        cairo_save(context_);
        rectangle(left, top, right, bottom);
        return cairo_clip(context_);
    }
    write_pending();
    left_ = left, top_ = top;
    *svg_ += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n", svg_number(left), svg_number(top),
                         svg_number(right - left), svg_number(bottom - top));
}

void Canvas::unclip() {
    if (svg_ == nullptr) return cairo_restore(context_);
    write_pending();
    left_ = top_ = 0;
    *svg_ += "</svg>\n";
}

double Canvas::width(const std::string& text, double size) {
    double width = 0;
    for (const auto& run : runs_of(text)) {
        cairo_set_font_size(context_, run.raised ? raised_size * size : size);
        cairo_text_extents_t extents;
        cairo_text_extents(context_, run.text.c_str(), &extents);
        width += extents.x_advance;
    }
    return width;
}

void Canvas::text(double x, double y, const std::string& text, double size, Anchor anchor, double turn) {
    if (text.empty()) return;
    constexpr double half_letter = 0.36;  // from the line below letters to their middle, of the size
    if (svg_ != nullptr) {
        const char* anchored = anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
        const auto style = fmt::format("{} font-size=\"{}\" text-anchor=\"{}\"", svg_colour("fill", tone_),
                                       svg_number(size), anchored);
        std::string rest =
            fmt::format(" x=\"{}\" y=\"{}\"", svg_number(x - left_), svg_number(y - top_ + half_letter * size));
        if (turn != 0)
            rest = fmt::format(" transform=\"translate({} {}) rotate({})\" y=\"{}\"", svg_number(x - left_),
                               svg_number(y - top_), svg_number(turn * 180 / std::numbers::pi),
                               svg_number(half_letter * size));
        rest += '>';
        const auto raise = svg_number(raised_by * size);
        bool high = false;
        for (const auto& run : runs_of(text)) {
            const auto moved = run.raised == high ? std::string() : fmt::format(" dy=\"{}{}\"", high ? "" : "-", raise);
            const auto small =
                run.raised ? fmt::format(" font-size=\"{}\"", svg_number(raised_size * size)) : std::string();
            rest += moved.empty() && small.empty()
                        ? svg_text(run.text)
                        : fmt::format("<tspan{}{}>{}</tspan>", moved, small, svg_text(run.text));
            high = run.raised;
        }
        return add(style, "text", rest + "</text>");
    }
    const double length = width(text, size);
    cairo_save(context_);
    cairo_translate(context_, x, y);
    cairo_rotate(context_, turn);
    double at = anchor == Anchor::start ? 0 : anchor == Anchor::middle ? -length / 2 : -length;
    for (const auto& run : runs_of(text)) {
        cairo_set_font_size(context_, run.raised ? raised_size * size : size);
        cairo_move_to(context_, at, half_letter * size - (run.raised ? raised_by * size : 0));
        cairo_show_text(context_, run.text.c_str());
        cairo_text_extents_t extents;
        cairo_text_extents(context_, run.text.c_str(), &extents);
        at += extents.x_advance;
    }
    cairo_restore(context_);
}

std::vector<std::string> Canvas::wrapped(const std::string& text, double size, double length) {
    std::vector<std::string> lines(1);
    for (std::size_t at = 0; at <= text.size();) {
        const auto end = std::min(text.find(' ', at), text.size());
        const auto word = text.substr(at, end - at);
        const auto longer = lines.back().empty() ? word : lines.back() + " " + word;
        if (lines.back().empty() || width(longer, size) <= length)
            lines.back() = longer;
        else
            lines.push_back(word);
        at = end + 1;
    }
    return lines;
}

}  // namespace grainsweep::plot
