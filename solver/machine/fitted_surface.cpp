// Surface of an STL file that repeats itself across a periodic domain: checks that it can, and fits it to the period.
#include "solver/geometry/loose_parts.hpp"
#include "solver/machine/shapes.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>

namespace grainsweep::machine {
namespace {

using geometry::Vec3;
using kit::sentence;

constexpr double alike = 1e-6;        // lengths that differ by less than this share of the surface's extent
constexpr double largest_tool = 0.5;  // m, along x and upwards

/// Lowest, foremost, rearmost, both along y, highest.
constexpr auto ends =
    std::to_array<geometry::End>({{2, false}, {0, true}, {0, false}, {1, false}, {1, true}, {2, true}});

void require_length(double length, double width) {
    if (length < width)
        throw std::invalid_argument(sentence(
            "the surface is %.4g m long along y, the layer %.4g m wide: it must span the width of the layer, so "
            "lengthen it, correct its scale or make the width smaller",
            length, width));
    throw std::invalid_argument(
        sentence("the surface is %.4g m long along y and not the same all along, and the layer repeats itself after "
                 "%.4g m: make "
                 "it just as long, or a profile with all corners at its two ends",
                 length, width));
}

void require_size(const geometry::Mesh& mesh, double scale) {
    const Vec3 low = mesh.low(), high = mesh.high();
    if (high[0] - low[0] <= largest_tool && high[2] - low[2] <= largest_tool) return;
    throw std::invalid_argument(
        sentence("the surface is %.3g m thick along x and %.3g m high, more than %.1f m: its scale is %.3g m for the "
                 "file's unit "
                 "of length, 0.001 for a file in mm",
                 high[0] - low[0], high[2] - low[2], largest_tool, scale));
}

/// Refuses a small part of the surface that hangs loose and would be its edge or one of its ends.
void require_one_body(const geometry::Mesh& mesh) {
    const auto loose = geometry::loose_triangles(mesh, 1, ends, small_share);
    if (!loose) return;
    const Vec3& at = loose->outermost;
    throw std::invalid_argument(
        sentence("%.0f of %.0f triangles, at (", static_cast<double>(loose->count),
                 static_cast<double>(mesh.triangles().size())) +
        sentence("%.4g, %.4g, %.4g) m of the file, are joined to the others along no closed edge, reach ", at[0], at[1],
                 at[2]) +
        sentence("%.3g m beyond them and would be the tool's edge or its end: remove stray triangles", loose->beyond));
}

/// Returns the surface from y = 0 to `width`, with its lowest point at z = 0 and x = 0.
geometry::Mesh fitted(const geometry::Mesh& given, double width) {
    geometry::TriangleSurface surface = given.surface();
    const double low = given.low()[1], high = given.high()[1];
    const double near = alike * std::max(high - low, width);
    if (high - low < width - near) require_length(high - low, width);
    if (high - low > width + near)
        for (const auto& corner : surface.corners)
            if (corner[1] > low + near && corner[1] < high - near) require_length(high - low, width);
    double edge = given.low()[0];
    for (const auto& corner : surface.corners)
        if (corner[2] <= given.low()[2] + near) edge = std::max(edge, corner[0]);
    for (auto& corner : surface.corners)
        corner = {corner[0] - edge, width * (corner[1] - low) / (high - low), corner[2] - given.low()[2]};
    return geometry::Mesh(std::move(surface), given.one_contact_angle());
}

}  // namespace

geometry::Mesh fitted_mesh(std::string_view stl, double scale, double facet_angle, double width) {
    using Key = std::tuple<std::size_t, std::size_t, double, double, double>;
    static std::mutex guard;
    static Key key;
    static geometry::Mesh made;
    const Key asked{std::hash<std::string_view>{}(stl), stl.size(), scale, facet_angle, width};
    const std::lock_guard lock(guard);
    if (key == asked) return made;
    const geometry::Mesh given = stl_mesh(stl, scale, facet_angle, {});
    require_one_body(given);
    require_size(given, scale);
    made = fitted(given, width);
    key = asked;
    return made;
}

}  // namespace grainsweep::machine
