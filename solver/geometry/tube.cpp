#include "solver/geometry/tube.hpp"

#include "solver/geometry/lines.hpp"

#include <algorithm>

namespace grainsweep::geometry {

Tube::Numbers Tube::numbers(const Vec3& centre, double unit, Vec3& origin) const {
    origin = (1 / unit) * (base - centre);
    Numbers n{};
    std::copy(axis.begin(), axis.end(), n.axis);
    n.middle = 0.5 * (inner + outer) / unit;
    n.half = 0.5 * (outer - inner) / unit;
    n.length = length / unit;
    return n;
}

Closest Tube::closest(const Vec3& x) const {
    Vec3 origin{};
    const Numbers own = numbers({}, 1, origin);
    const Vec3 r = x - origin;
    const auto found = near(own, r[0], r[1], r[2]);
    return {found.distance, {found.x, found.y, found.z}};
}

bool Tube::unchanged_by_turn(const Vec3& on_axis, const Vec3& turn) const {
    return parallel(axis, turn) && on_line(on_axis, base, axis, outer);
}

Extent Tube::extent(std::size_t along) const {
    const double sine = std::sqrt(std::max(0.0, 1 - axis[along] * axis[along]));
    const double end = base[along] + length * axis[along];
    return {std::min(base[along], end) - outer * sine, std::max(base[along], end) + outer * sine};
}

std::string Tube::flaw() const {
    if (!finite(base) || !finite(axis)) return "a tube must be finite";
    if (!is_unit(axis)) return "the axis of a tube must have unit length";
    if (!(std::isfinite(length) && length > 0)) return "the length of a tube must be positive";
    if (!(std::isfinite(outer) && inner > 0 && outer > inner))
        return "the inner radius of a tube must be positive, and the outer one larger";
    return {};
}

}  // namespace grainsweep::geometry
