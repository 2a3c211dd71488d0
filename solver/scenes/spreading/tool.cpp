#include "solver/scenes/spreading/tool.hpp"

#include "solver/scenes/spreading/study.hpp"

#include <utility>
#include <vector>

namespace grainsweep::spreading {
namespace {

using geometry::operator+;

constexpr double blade_top = 0.150;  // m: nothing jumps over it

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

}  // namespace

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
