// Panels side by side on paper, and the paper as a file.
#include "sweep/files/broken_world.hpp"
#include "sweep/plot/panel.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace grainsweep::plot {
namespace {

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
        throw BrokenWorld(fmt::format("the figure cannot be drawn: {}", cairo_status_to_string(status)));
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
void draw(cairo_t* context, const Figure& figure, const Layout& layout) {
    Canvas canvas(context);
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

std::string as_vectors(const Figure& figure, const Layout& layout, double width, FileType type) {
    std::string bytes;
    const double height = layout.total_height();
    const Surface surface(type == FileType::pdf
                              ? cairo_pdf_surface_create_for_stream(collect_bytes, &bytes, width, height)
                              : cairo_svg_surface_create_for_stream(collect_bytes, &bytes, width, height));
    if (type == FileType::pdf)
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    {
        const Context context(cairo_create(surface.get()));
        draw(context.get(), figure, layout);
    }
    cairo_surface_finish(surface.get());
    require_drawn(cairo_surface_status(surface.get()));
    return bytes;
}

}  // namespace

std::string drawn(const Figure& figure, double width_mm, FileType type) {
    const auto layout = layout_of(figure, width_mm);
    const double width = width_mm * points_per_mm;
    return type == FileType::png ? as_png(figure, layout, width) : as_vectors(figure, layout, width, type);
}

}  // namespace grainsweep::plot
