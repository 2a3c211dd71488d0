#include "solver/scenes/spreading/tool.hpp"

#include "solver/scenes/spreading/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace grainsweep::spreading {
namespace {

using geometry::operator+;

constexpr double blade_top = 0.150;  // m: nothing jumps over it
constexpr double alike = 1e-6;       // lengths that differ by less than this share of the surface's extent

std::vector<geometry::Motion> vibrating(const Study& s) {
    if (!(s.vibration_frequency > 0)) return {};
    return {geometry::Vibration{.amplitude = {0, 0, s.vibration_amplitude}, .frequency = s.vibration_frequency}};
}

dem::Wall roller(const Study& s, double level) {
    const double radius = s.roller_diameter / 2;
    const dem::Vec3 axis{0, 1, 0}, middle{s.edge(0), 0, level + s.gap + radius};
    auto motions = vibrating(s);
    motions.emplace_back(geometry::Translation{.velocity = {s.speed, 0, 0}});
    if (s.roller_spin != 0)
        motions.emplace_back(
            geometry::Rotation{.point = middle, .axis = axis, .speed = -s.roller_spin * s.speed / radius});
    return {geometry::Cylinder{.point = middle, .axis = axis, .radius = radius, .side = geometry::Side::outside},
            motions};
}

dem::Wall surface(const Study& s, double level) {
    geometry::TriangleSurface placed = s.surface.surface();
    for (auto& corner : placed.corners) corner = corner + dem::Vec3{s.edge(0), 0, level + s.gap};
    auto motions = vibrating(s);
    motions.emplace_back(geometry::Translation{.velocity = {s.speed, 0, 0}});
    return {geometry::Mesh(std::move(placed), s.surface.one_contact_angle()), motions};
}

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

dem::Wall tool_wall(const Study& s, double level) {
    switch (s.tool) {
        case Tool::roller:
            return roller(s, level);
        case Tool::file:
            return surface(s, level);
        case Tool::blade:
            break;
    }
    return dem::Blade{.front = s.blade_start,
                      .thickness = s.blade_thickness,
                      .bottom = level + s.gap,
                      .top = level + blade_top,
                      .speed = s.speed,
                      .amplitude = s.vibration_frequency > 0 ? s.vibration_amplitude : 0.0,
                      .frequency = s.vibration_frequency,
                      .edge_radius = s.blade_edge_radius};
}

}  // namespace grainsweep::spreading
