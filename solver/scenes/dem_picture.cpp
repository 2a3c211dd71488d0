#include "solver/scenes/dem_picture.hpp"

#include "solver/geometry/bounds.hpp"
#include "solver/geometry/motion.hpp"
#include "solver/observables/particle_loads.hpp"

#include <algorithm>
#include <cmath>
#include <map>
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

void show(const geometry::Plane& given, const geometry::Pose& pose, const Vec3& low, const Vec3& high,
          WallSurface& surface) {
    const geometry::Plane plane{pose.from_body(given.point), pose.turn(given.normal)};
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
    std::vector<std::array<double, 2>> line{{bar.rear(), top}};
    const auto round_edge = [&](double x, double start) {
        for (int k = 0; k <= steps; ++k) {
            const double angle = start + std::numbers::pi / 2 * k / steps;
            line.push_back({x + r * std::cos(angle), bar.bottom + r + r * std::sin(angle)});
        }
    };
    if (r > 0) {
        round_edge(bar.rear() + r, std::numbers::pi);
        round_edge(bar.front - r, 1.5 * std::numbers::pi);
    } else {
        line.push_back({bar.rear(), bar.bottom});
        line.push_back({bar.front, bar.bottom});
    }
    line.push_back({bar.front, top});
    return line;
}

void show(const geometry::Bar& given, const geometry::Pose& pose, const Vec3& low, const Vec3& high,
          WallSurface& surface) {
    const geometry::Bar bar = pose.turned ? given : given.moved(pose.shift);
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
    if (pose.turned)
        for (Vec3& corner : surface.corners) corner = pose.from_body(corner);
}

/// Body of revolution between two circles about a line; solid ones with their flat ends.
void show_round(const Vec3& first, const Vec3& second, double first_radius, double second_radius, bool ends,
                WallSurface& surface) {
    constexpr std::int32_t sides = 48;
    const Vec3 axis = (1 / geometry::norm(second - first)) * (second - first);
    const Vec3 across = std::abs(axis[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = (1 / geometry::norm(geometry::cross(axis, across))) * geometry::cross(axis, across);
    const Vec3 v = geometry::cross(axis, u);
    const auto circle = [&](const Vec3& centre, double radius) {
        for (std::int32_t k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            surface.corners.push_back(centre + (radius * std::cos(angle)) * u + (radius * std::sin(angle)) * v);
        }
    };
    circle(first, first_radius);
    circle(second, second_radius);
    for (std::int32_t k = 0; k < sides; ++k) {
        const std::int32_t next = (k + 1) % sides;
        surface.triangles.push_back({k, next, sides + next});
        surface.triangles.push_back({k, sides + next, sides + k});
        surface.edges.push_back({k, next});
        surface.edges.push_back({sides + k, sides + next});
    }
    if (!ends) return;
    close_polygon(surface, 0, sides);
    close_polygon(surface, sides, sides);
}

void show(const geometry::Cylinder& given, const geometry::Pose& pose, const Vec3& low, const Vec3& high,
          WallSurface& surface) {
    const Vec3 point = pose.from_body(given.point), axis = pose.turn(given.axis);
    const bool ends = std::isfinite(given.length);
    double from = ends ? -given.length / 2 : 1e300, to = ends ? given.length / 2 : -1e300;
    for (unsigned c = 0; c < 8 && !ends; ++c) {  // along the whole box
        const Vec3 corner{(c & 1U) != 0 ? high[0] : low[0], (c & 2U) != 0 ? high[1] : low[1],
                          (c & 4U) != 0 ? high[2] : low[2]};
        from = std::min(from, geometry::dot(corner - point, axis));
        to = std::max(to, geometry::dot(corner - point, axis));
    }
    show_round(point + from * axis, point + to * axis, given.radius, given.radius,
               ends && given.side == geometry::Side::outside, surface);
}

void show(const geometry::Cone& given, const geometry::Pose& pose, const Vec3&, const Vec3&, WallSurface& surface) {
    const Vec3 base = pose.from_body(given.base);
    show_round(base, base + given.length * pose.turn(given.axis), given.base_radius, given.end_radius,
               given.side == geometry::Side::outside, surface);
}

/// Lines where a surface ends, forks or turns by more than about 15 degrees.
std::vector<std::array<std::int32_t, 2>> outline(const geometry::Mesh& mesh) {
    constexpr double flat = 0.966;  // cosine
    std::map<std::array<std::int32_t, 2>, std::vector<Vec3>> sides;
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
        const auto& corner = mesh.surface().triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(corner[k], corner[(k + 1) % 3]);
            sides[{a, b}].push_back(mesh.triangles()[t].normal);
        }
    }
    std::vector<std::array<std::int32_t, 2>> lines;
    for (const auto& [side, normals] : sides)
        if (normals.size() != 2 || std::abs(geometry::dot(normals[0], normals[1])) < flat) lines.push_back(side);
    return lines;
}

void show(const geometry::Mesh& mesh, const geometry::Pose& pose, const Vec3&, const Vec3&, WallSurface& surface) {
    for (const Vec3& corner : mesh.surface().corners) surface.corners.push_back(pose.from_body(corner));
    surface.triangles = mesh.surface().triangles;
    surface.edges = outline(mesh);
}

void show(const geometry::Tube& given, const geometry::Pose& pose, const Vec3&, const Vec3&, WallSurface& surface) {
    const Vec3 base = pose.from_body(given.base), end = base + given.length * pose.turn(given.axis);
    show_round(base, end, given.inner, given.inner, false, surface);
    WallSurface outer;
    show_round(base, end, given.outer, given.outer, false, outer);
    const auto first = static_cast<std::int32_t>(surface.corners.size());
    surface.corners.insert(surface.corners.end(), outer.corners.begin(), outer.corners.end());
    for (const auto& [a, b, c] : outer.triangles) surface.triangles.push_back({first + a, first + b, first + c});
    for (const auto& [a, b] : outer.edges) surface.edges.push_back({first + a, first + b});
}

}  // namespace

WallSurface surface_of(const dem::Wall& wall, std::string name, const Vec3& low, const Vec3& high, double time) {
    WallSurface surface;
    surface.name = std::move(name);
    const geometry::Pose pose = geometry::pose_at(wall.motions, time);
    std::visit([&](const auto& shape) { show(shape, pose, low, high, surface); }, wall.shape);
    return surface;
}

namespace {

/// A number per contact in every column; "second" and "wall" are -1 where the partner is a wall or a particle.
ContactLines lines_of(const dem::State& state, std::span<const dem::ContactForce> contacts) {
    ContactLines lines;
    std::vector<double> first, second, at_wall, normal_force, tangential_force, overlap, slides;
    std::vector<Vec3> force;
    for (const dem::ContactForce& contact : contacts) {
        const auto at = [&](std::int32_t id) {
            return static_cast<std::size_t>(std::ranges::lower_bound(state.id, id) - state.id.begin());
        };
        const std::size_t i = at(contact.first);
        const bool wall = contact.second < 0;
        const double distance = state.radius[i] + (wall ? 0 : state.radius[at(contact.second)]) - contact.overlap;
        lines.ends.push_back({state.position[i], state.position[i] - distance * contact.normal});
        first.push_back(contact.first);
        second.push_back(wall ? -1 : contact.second);
        at_wall.push_back(wall ? -1 - contact.second : -1);
        normal_force.push_back(contact.normal_force);
        tangential_force.push_back(geometry::norm(contact.tangential_force));
        overlap.push_back(contact.overlap);
        slides.push_back(contact.slides ? 1 : 0);
        force.push_back(contact.normal_force * contact.normal + contact.tangential_force);
    }
    lines.scalars = {{"first", std::move(first)},
                     {"second", std::move(second)},
                     {"wall", std::move(at_wall)},
                     {"normal_force", std::move(normal_force)},
                     {"tangential_force", std::move(tangential_force)},
                     {"overlap", std::move(overlap)},
                     {"slides", std::move(slides)}};
    lines.vectors["force"] = std::move(force);
    lines.units = {{"normal_force", "N"}, {"tangential_force", "N"}, {"overlap", "m"}, {"force", "N"}};
    return lines;
}

}  // namespace

Snapshot picture_of(const dem::Engine& engine) {
    dem::State state;
    std::vector<dem::ContactForce> contacts;
    engine.state(state);
    engine.contacts(contacts);
    auto loads = observables::particle_loads(state, contacts);
    Snapshot picture;
    picture.contacts = lines_of(state, contacts);
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

std::int32_t add_box(const std::array<double, 3>& low, const std::array<double, 3>& high, WallSurface& surface) {
    const auto first = static_cast<std::int32_t>(surface.corners.size());
    for (std::size_t corner = 0; corner < 8; ++corner)
        surface.corners.push_back(geometry::Bounds{low, high}.corner(corner));
    for (std::int32_t corner = 0; corner < 8; ++corner)
        for (const std::int32_t bit : {1, 2, 4})
            if ((corner & bit) == 0) surface.edges.push_back({first + corner, first + corner + bit});
    return first;
}

}  // namespace grainsweep
