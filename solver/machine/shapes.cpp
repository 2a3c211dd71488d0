#include "solver/machine/shapes.hpp"

#include "solver/geometry/motion.hpp"
#include "solver/geometry/stl.hpp"
#include "solver/geometry/weld.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::machine {

using geometry::cross;
using geometry::norm;
using geometry::Vec3;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;

namespace {

constexpr int facets = 64;

geometry::Pose pose_of(const Placement& placement) {
    const std::array<geometry::Motion, 1> turn = {
        geometry::Rotation{.point = placement.through, .axis = placement.axis, .speed = placement.angle}};
    geometry::Pose pose;
    if (placement.angle != 0) pose = geometry::pose_at(turn, 1);
    pose.shift = pose.shift + placement.at;
    return pose;
}

}  // namespace

Triangles rectangle(const Vec3& corner, const Vec3& along, const Vec3& across) {
    const Vec3 b = corner + along, c = corner + along + across, d = corner + across;
    return {{corner, b, c}, {corner, c, d}};
}

Triangles disc(const Vec3& centre, const Vec3& normal, double radius, double inner) {
    if (!(inner < radius)) throw std::invalid_argument("the inner radius of a disc must be less than its radius");
    const Vec3 across = std::abs(normal[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = (1 / norm(cross(normal, across))) * cross(normal, across);
    const Vec3 v = cross(normal, u);
    // A polygon of this radius has the area of the circle.
    const double angle = 2 * std::numbers::pi / facets, wider = std::sqrt(angle / std::sin(angle));
    const auto corner = [&](double r, int k) {
        return centre + wider * r * std::cos(angle * k) * u + wider * r * std::sin(angle * k) * v;
    };
    Triangles triangles;
    for (int k = 0; k < facets; ++k) {
        const int next = (k + 1) % facets;
        if (inner > 0) {
            triangles.push_back({corner(inner, k), corner(radius, k), corner(radius, next)});
            triangles.push_back({corner(inner, k), corner(radius, next), corner(inner, next)});
        } else {
            triangles.push_back({centre, corner(radius, k), corner(radius, next)});
        }
    }
    return triangles;
}

Triangles box(const Vec3& low, const Vec3& high, const std::array<bool, 6>& open) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!(low[k] < high[k]))
            throw std::invalid_argument("\"low\" of a box must lie below \"high\" along every axis");
    Triangles all;
    const Vec3 size = high - low;
    for (std::size_t k = 0; k < 3; ++k) {
        Vec3 along{}, across{}, up{};
        along[(k + 1) % 3] = size[(k + 1) % 3];
        across[(k + 2) % 3] = size[(k + 2) % 3];
        up[k] = size[k];
        for (const bool upper : {false, true}) {
            if (open[2 * k + (upper ? 1 : 0)]) continue;
            for (const auto& triangle : rectangle(upper ? low + up : low, along, across)) all.push_back(triangle);
        }
    }
    return all;
}

geometry::Mesh mesh_of(Triangles triangles, double facet_angle, const Placement& placement) {
    if (triangles.empty()) throw std::invalid_argument("it has no triangle");
    const auto pose = pose_of(placement);
    for (auto& triangle : triangles)
        for (Vec3& corner : triangle) {
            corner = pose.from_body(corner);
            if (!geometry::finite(corner)) throw std::invalid_argument("a corner is no number");
        }
    auto surface = geometry::weld(triangles).surface;
    if (surface.triangles.empty()) throw std::invalid_argument("its triangles have no area");
    return geometry::Mesh(std::move(surface), facet_angle);
}

geometry::Mesh stl_mesh(std::string_view contents, double scale, double facet_angle, const Placement& placement) {
    auto surface = geometry::read_stl(contents, scale).surface;
    const auto pose = pose_of(placement);
    for (Vec3& corner : surface.corners) corner = pose.from_body(corner);
    return geometry::Mesh(std::move(surface), facet_angle);
}

std::optional<geometry::Solid> solid_of(const geometry::Shape& shape) {
    const auto* mesh = std::get_if<geometry::Mesh>(&shape);
    return mesh != nullptr ? geometry::solid_of(mesh->surface()) : std::nullopt;
}

}  // namespace grainsweep::machine
