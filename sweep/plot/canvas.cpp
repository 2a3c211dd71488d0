#include "sweep/plot/canvas.hpp"

#include <cairo.h>

#include <array>
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

}  // namespace

Canvas::Canvas(cairo_t* context) : context_(context) {
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

void Canvas::use(Colour tone) {
    cairo_set_source_rgba(context_, tone.red, tone.green, tone.blue, tone.alpha);
}

void Canvas::use(Colour tone, double line_width, bool dashed) {
    use(tone);
    cairo_set_line_width(context_, line_width);
    constexpr std::array<double, 2> dashes = {3, 2};
    cairo_set_dash(context_, dashes.data(), dashed ? 2 : 0, 0);
}

void Canvas::segment(double x0, double y0, double x1, double y1) {
    cairo_move_to(context_, x0, y0);
    cairo_line_to(context_, x1, y1);
}

void Canvas::rectangle(double left, double top, double right, double bottom) {
    cairo_rectangle(context_, left, top, right - left, bottom - top);
}

void Canvas::stroke() {
    cairo_stroke(context_);
}

void Canvas::fill() {
    cairo_fill(context_);
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
    constexpr double half_letter = 0.36;  // from the line below letters to their middle, of the size
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
