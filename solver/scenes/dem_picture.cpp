#include "solver/scenes/dem_picture.hpp"

#include "solver/dem/moving_wall.hpp"
#include "solver/observables/particle_loads.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep {
namespace {

using geometry::operator+;
using geometry::operator-;
using geometry::operator*;
using geometry::Vec3;
using Polygon = std::vector<Vec3>;

/// The part of a convex polygon where `inside`, linear in the place, is not negative.
template <class Inside>
Polygon clipped(const Polygon& polygon, Inside inside) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        const double fa = inside(a);
        const double fb = inside(b);
        if (fa >= 0) kept.push_back(a);
        if ((fa < 0) != (fb < 0)) kept.push_back(a + (fa / (fa - fb)) * (b - a));
    }
    return kept;
}

void close_polygon(WallSurface& surface, std::int32_t first, std::int32_t corners) {
    for (std::int32_t k = 1; k + 1 < corners; ++k) surface.triangles.push_back({first, first + k, first + k + 1});
}

void show(const geometry::Plane& plane, const Vec3& low, const Vec3& high, WallSurface& surface) {
    // A square beyond the box in the plane: the smallest component of the normal shows a direction across it.
    const auto least = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto axis = std::ranges::min_element(plane.normal, least) - plane.normal.begin();
    Vec3 along{};
    along[static_cast<std::size_t>(axis)] = 1;
    const Vec3 u = geometry::cross(plane.normal, along);
    const Vec3 v = geometry::cross(plane.normal, u);
    const Vec3 middle = 0.5 * (low + high);
    const Vec3 foot = middle - geometry::dot(middle - plane.point, plane.normal) * plane.normal;
    const double reach = 2 * geometry::norm(high - low) / std::max(geometry::norm(u), 1e-9);
    Polygon polygon = {foot - reach * u - reach * v, foot + reach * u - reach * v, foot + reach * u + reach * v,
                       foot - reach * u + reach * v};
    for (std::size_t k = 0; k < 3; ++k) {
        polygon = clipped(polygon, [&](const Vec3& x) { return x[k] - low[k]; });
        polygon = clipped(polygon, [&](const Vec3& x) { return high[k] - x[k]; });
    }
    if (polygon.size() < 3) return;
    surface.corners = std::move(polygon);
    close_polygon(surface, 0, static_cast<std::int32_t>(surface.corners.size()));
}

/// Outline of the bar in the xz plane, from the upper rear corner down, around and up, at the height `top`.
std::vector<std::array<double, 2>> outline(const geometry::Bar& bar, double top) {
    constexpr int steps = 6;  // of a quarter circle
    const double r = bar.edge_radius;
    std::vector<std::array<double, 2>> line{{bar.rear, top}};
    const auto round_edge = [&](double x, double start) {
        for (int k = 0; k <= steps; ++k) {
            const double angle = start + std::numbers::pi / 2 * k / steps;
            line.push_back({x + r * std::cos(angle), bar.bottom + r + r * std::sin(angle)});
        }
    };
    if (r > 0) {
        round_edge(bar.rear + r, std::numbers::pi);
        round_edge(bar.front - r, 1.5 * std::numbers::pi);
    } else {
        line.push_back({bar.rear, bar.bottom});
        line.push_back({bar.front, bar.bottom});
    }
    line.push_back({bar.front, top});
    return line;
}

void show(const geometry::Bar& bar, const Vec3& low, const Vec3& high, WallSurface& surface) {
    const double top = std::min(bar.top, high[2]);
    if (!(bar.bottom + bar.edge_radius < top)) return;
    const auto line = outline(bar, top);
    const auto n = static_cast<std::int32_t>(line.size());
    for (const double y : {low[1], high[1]})
        for (const auto& [x, z] : line) surface.corners.push_back({x, y, z});
    for (std::int32_t k = 0; k < n; ++k) {
        const std::int32_t next = (k + 1) % n;
        surface.triangles.push_back({k, next, n + next});
        surface.triangles.push_back({k, n + next, n + k});
        surface.edges.push_back({k, next});
        surface.edges.push_back({n + k, n + next});
    }
    close_polygon(surface, 0, n);
    close_polygon(surface, n, n);
}

}  // namespace

WallSurface surface_of(const dem::Wall& wall, std::string name, const Vec3& low, const Vec3& high, double time) {
    WallSurface surface;
    surface.name = std::move(name);
    std::visit([&](const auto& w) { show(dem::shape_at(w, time), low, high, surface); }, wall);
    return surface;
}

Snapshot picture_of(const dem::Engine& engine) {
    dem::State state;
    std::vector<dem::ContactForce> contacts;
    engine.state(state);
    engine.contacts(contacts);
    auto loads = observables::particle_loads(state, contacts);
    Snapshot picture;
    picture.positions = std::move(state.position);
    picture.scalars["id"].assign(state.id.begin(), state.id.end());
    picture.scalars["mobile"].assign(state.mobile.begin(), state.mobile.end());
    for (const double radius : state.radius) picture.scalars["diameter"].push_back(2 * radius);
    picture.scalars["overlap"] = std::move(loads.overlap);
    picture.scalars["largest_force"] = std::move(loads.largest);
    picture.scalars["coordination"] = std::move(loads.coordination);
    picture.vectors["velocity"] = std::move(state.velocity);
    picture.vectors["angular_velocity"] = std::move(state.angular_velocity);
    picture.vectors["force"] = std::move(loads.force);
    picture.units = {
        {"diameter", "m"}, {"overlap", "m"}, {"largest_force", "N"}, {"velocity", "m/s"}, {"angular_velocity", "rad/s"},
        {"force", "N"}};
    return picture;
}

}  // namespace grainsweep
