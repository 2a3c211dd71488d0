#include "solver/geometry/cylinder.hpp"

#include "solver/geometry/lines.hpp"

#include <algorithm>

namespace grainsweep::geometry {

Vec3 Cylinder::foot() const {
    return std::isfinite(length) ? point - (0.5 * length) * axis : point;
}

Meridian Cylinder::meridian(double unit) const {
    Meridian m{};
    std::copy(axis.begin(), axis.end(), m.axis);
    m.base = m.end = radius / unit;
    m.length = m.slant = length / unit;
    m.along = 1;
    m.side = side == Side::inside ? 1 : -1;
    return m;
}

Closest Cylinder::closest(const Vec3& x) const {
    const Vec3 r = x - foot();
    const Meridian m = meridian(1);
    const auto found = near(m, r[0], r[1], r[2]);
    return {found.distance, {found.x, found.y, found.z}};
}

bool Cylinder::unchanged_by_shift(const Vec3& direction) const {
    return !std::isfinite(length) && parallel(axis, direction);
}

bool Cylinder::unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const {
    return parallel(axis, turn) && on_line(on_axis, point, axis, radius);
}

Extent Cylinder::extent(std::size_t along) const {
    if (side == Side::inside) return {};
    const double cosine = std::abs(axis[along]);
    if (!std::isfinite(length) && cosine > 0) return {};
    const double half =
        (cosine > 0 ? 0.5 * length * cosine : 0) + radius * std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {point[along] - half, point[along] + half};
}

std::string Cylinder::flaw() const {
    if (!finite(point) || !finite(axis)) return "a cylinder must be finite";
    if (!is_unit(axis)) return "the axis of a cylinder must have unit length";
    if (!(std::isfinite(radius) && radius > 0)) return "the radius of a cylinder must be positive";
    return length > 0 ? "" : "the length of a cylinder must be positive";
}

}  // namespace grainsweep::geometry
