#include "solver/geometry/bar.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::geometry {
namespace {

/// From a point (cx, cz) of the solid's skeleton at depth `radius` below the surface.
Closest from_skeleton(double dx, double dz, double radius) {
    const double r = std::hypot(dx, dz);
    return {r - radius, {dx / r, 0, dz / r}};
}

}  // namespace

Closest Bar::closest(const Vec3& x) const {
    const double rear = this->rear();
    const double px = x[0];
    const double pz = x[2];
    // Beyond the centre of a rounded lower edge, seen from the solid, the surface is that edge's arc.
    const bool low = pz < bottom + edge_radius;
    if (low && px > front - edge_radius && (edge_radius > 0 || px > front)) {
        const double dx = px - (front - edge_radius);
        const double dz = pz - (bottom + edge_radius);
        return from_skeleton(dx, dz, edge_radius);
    }
    if (low && px < rear + edge_radius && (edge_radius > 0 || px < rear)) {
        const double dx = px - (rear + edge_radius);
        const double dz = pz - (bottom + edge_radius);
        return from_skeleton(dx, dz, edge_radius);
    }
    const double nearest_x = std::clamp(px, rear, front);
    const double nearest_z = std::clamp(pz, bottom, top);
    const double dx = px - nearest_x;
    const double dz = pz - nearest_z;
    if (dx != 0 || dz != 0) {
        if (dz == 0) return {std::abs(dx), {dx > 0 ? 1.0 : -1.0, 0, 0}};
        if (dx == 0) return {std::abs(dz), {0, 0, dz > 0 ? 1.0 : -1.0}};
        return from_skeleton(dx, dz, 0);
    }
    const double to_front = front - px;
    const double to_rear = px - rear;
    const double to_bottom = pz - bottom;
    const double to_top = top - pz;
    const double depth = std::min({to_front, to_rear, to_bottom, to_top});
    if (depth == to_front) return {-depth, {1, 0, 0}};
    if (depth == to_rear) return {-depth, {-1, 0, 0}};
    if (depth == to_bottom) return {-depth, {0, 0, -1}};
    return {-depth, {0, 0, 1}};
}

Extent Bar::extent(std::size_t axis) const {
    if (axis == 0) return {rear(), front};
    if (axis == 2) return {bottom, top};
    return {};
}

Bar::Numbers Bar::numbers(const Vec3& centre, double unit, Vec3& origin) const {
    Numbers n{};
    n.half_width = 0.5 * thickness / unit;
    n.bottom = (bottom - centre[2]) / unit;
    n.top = (top - centre[2]) / unit;
    n.edge_radius = std::min(edge_radius, 0.5 * thickness) / unit;
    origin = {(front - centre[0]) / unit - n.half_width, 0, 0};
    return n;
}

std::string Bar::flaw() const {
    for (const double x : {front, thickness, bottom, top, edge_radius})
        if (!std::isfinite(x)) return "a blade must be finite";
    if (!(thickness > 0 && top > bottom)) return "a blade must have a thickness and a height";
    if (!(edge_radius >= 0 && 2 * edge_radius <= std::min(thickness, top - bottom)))
        return "the edge radius of a blade must not exceed half its thickness or height";
    return {};
}

}  // namespace grainsweep::geometry
