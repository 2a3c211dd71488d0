#include "solver/geometry/cone.hpp"

#include "solver/geometry/lines.hpp"

#include <algorithm>

namespace grainsweep::geometry {

Meridian Cone::meridian(double unit) const {
    Meridian m{};
    std::copy(axis.begin(), axis.end(), m.axis);
    m.base = base_radius / unit;
    m.end = end_radius / unit;
    m.length = length / unit;
    m.slant = std::hypot(m.end - m.base, m.length);
    m.along = m.length / m.slant;
    m.across = (m.end - m.base) / m.slant;
    m.side = side == Side::inside ? 1 : -1;
    return m;
}

Closest Cone::closest(const Vec3& x) const {
    const Vec3 r = x - base;
    const auto found = near(meridian(1), r[0], r[1], r[2]);
    return {found.distance, {found.x, found.y, found.z}};
}

bool Cone::unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const {
    return parallel(axis, turn) && on_line(on_axis, base, axis, std::max(base_radius, end_radius));
}

Extent Cone::extent(std::size_t along) const {
    if (side == Side::inside) return {};
    const double sine = std::sqrt(std::max(0.0, 1 - axis[along] * axis[along]));
    const double end = base[along] + length * axis[along];
    return {std::min(base[along] - base_radius * sine, end - end_radius * sine),
            std::max(base[along] + base_radius * sine, end + end_radius * sine)};
}

std::string Cone::flaw() const {
    if (!finite(base) || !finite(axis)) return "a cone must be finite";
    if (!is_unit(axis)) return "the axis of a cone must have unit length";
    if (!(std::isfinite(length) && length > 0)) return "the length of a cone must be positive";
    if (!(std::isfinite(base_radius) && std::isfinite(end_radius) && base_radius >= 0 && end_radius >= 0 &&
          base_radius + end_radius > 0))
        return "the radii of a cone must not be negative, and one of them positive";
    return {};
}

}  // namespace grainsweep::geometry
