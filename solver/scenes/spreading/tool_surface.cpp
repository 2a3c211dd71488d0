// The tool of an STL file: checked against what a tool can be, fitted to the layer's width.
#include "solver/scenes/kit/stl_wall.hpp"
#include "solver/scenes/spreading/question.hpp"
#include "solver/scenes/spreading/tool.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace grainsweep::spreading {
namespace {

using geometry::Vec3;

constexpr double alike = 1e-6;        // lengths that differ by less than this share of the surface's extent
constexpr double largest_tool = 0.5;  // m, along the travel and upwards
constexpr double stray_share = 0.02;  // of the surface: less, apart from all the rest, is no part of a tool
constexpr double stray_gap = 1e-5;    // of the extent: nearer is not apart

void require_length(double length, double width) {
    char sentence[240];
    std::snprintf(sentence, sizeof sentence,
                  "tool: the surface is %.4g m long along y, the layer %.4g m wide: a tool must span the width of the "
                  "layer, so lengthen it, correct tool_scale or make width smaller",
                  length, width);
    if (length < width) throw std::invalid_argument(sentence);
    std::snprintf(sentence, sizeof sentence,
                  "tool: the surface is %.4g m long along y and not the same all along, and the layer repeats itself "
                  "after %.4g m: make it just as long, or a profile with all corners at its two ends",
                  length, width);
    throw std::invalid_argument(sentence);
}

void require_size(const geometry::Mesh& mesh, double scale) {
    const Vec3 low = mesh.low(), high = mesh.high();
    if (high[0] - low[0] <= largest_tool && high[2] - low[2] <= largest_tool) return;
    char sentence[280];
    std::snprintf(sentence, sizeof sentence,
                  "tool: the surface is %.3g m thick along x and %.3g m high, more than %.1f m: tool_scale is %.3g m "
                  "for the file's unit of length, 0.001 for a file in mm",
                  high[0] - low[0], high[2] - low[2], largest_tool, scale);
    throw std::invalid_argument(sentence);
}

/// One triangle along an axis.
struct Span {
    double low = 0, high = 0, area = 0;
    std::size_t triangle = 0;
};

const Vec3& corner_of(const geometry::TriangleSurface& surface, std::size_t triangle, std::size_t k) {
    return surface.corners[static_cast<std::size_t>(surface.triangles[triangle][k])];
}

std::vector<Span> spans_of(const geometry::TriangleSurface& surface, std::size_t axis) {
    using namespace geometry;
    std::vector<Span> spans;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Vec3 &a = corner_of(surface, t, 0), &b = corner_of(surface, t, 1), &c = corner_of(surface, t, 2);
        spans.push_back({std::min({a[axis], b[axis], c[axis]}), std::max({a[axis], b[axis], c[axis]}),
                         norm(cross(b - a, c - a)) / 2, t});
    }
    return spans;
}

[[noreturn]] void refuse_stray(const geometry::TriangleSurface& surface, std::size_t count, std::size_t triangle,
                               double gap) {
    const Vec3& at = corner_of(surface, triangle, 0);
    char sentence[280];
    std::snprintf(
        sentence, sizeof sentence,
        "tool: %zu of %zu triangles, at (%.4g, %.4g, %.4g) m of the file, lie %.3g m apart from all others and "
        "would be the tool's edge or its end: remove stray triangles",
        count, surface.triangles.size(), at[0], at[1], at[2], gap);
    throw std::invalid_argument(sentence);
}

/// Refuses a small part of the surface that lies apart from the rest along an axis.
void require_one_body(const geometry::TriangleSurface& surface) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto spans = spans_of(surface, axis);
        std::ranges::sort(spans, {}, &Span::low);
        double area = 0, most = spans.front().high;
        for (const Span& span : spans) area += span.area, most = std::max(most, span.high);
        const double least_gap = stray_gap * (most - spans.front().low);
        double below = 0, reach = spans.front().high;
        for (std::size_t k = 0; k < spans.size(); ++k) {
            const double gap = spans[k].low - reach;
            if (k > 0 && gap > least_gap && below <= stray_share * area)
                refuse_stray(surface, k, spans[0].triangle, gap);
            if (k > 0 && gap > least_gap && area - below <= stray_share * area)
                refuse_stray(surface, spans.size() - k, spans[k].triangle, gap);
            below += spans[k].area;
            reach = std::max(reach, spans[k].high);
        }
    }
}

}  // namespace

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

geometry::Mesh tool_surface(std::string_view stl, double scale, double facet_angle, double width) {
    using Key = std::tuple<std::size_t, std::size_t, double, double, double>;
    static std::mutex guard;
    static Key key;
    static geometry::Mesh made;
    const Key asked{std::hash<std::string_view>{}(stl), stl.size(), scale, facet_angle, width};
    const std::lock_guard lock(guard);
    if (key == asked) return made;
    const geometry::Mesh given = kit::mesh_of(question::tool.name, stl, scale, facet_angle);
    require_one_body(given.surface());
    require_size(given, scale);
    made = fitted(given, width);
    key = asked;
    return made;
}

}  // namespace grainsweep::spreading
