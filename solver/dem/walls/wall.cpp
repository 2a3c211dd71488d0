#include "solver/dem/walls/wall.hpp"

#include "solver/bytes.hpp"
#include "solver/dem/walls/wall_bytes.hpp"

#include <cmath>
#include <cstddef>

namespace grainsweep::dem {

std::string flaw(const Surface& s, std::string_view whom) {
    const auto complaint = [&](std::string_view part, std::string_view rule) {
        return std::string("the ").append(part).append(" of ").append(whom).append(rule);
    };
    const auto negative = [](const std::optional<double>& x) { return x && !(std::isfinite(*x) && *x >= 0); };
    if (negative(s.friction)) return complaint("friction", " must not be negative");
    if (s.rolling_friction && !(*s.rolling_friction >= 0 && *s.rolling_friction <= 1))
        return complaint("rolling friction", " must lie in [0, 1]");
    if (s.restitution && !(*s.restitution > 0 && *s.restitution <= 1))
        return complaint("restitution", " must lie in (0, 1]");
    if (negative(s.cohesion)) return complaint("cohesion energy density", " must not be negative");
    if (negative(s.surface_energy)) return complaint("surface energy", " must not be negative");
    return {};
}

bool same_body(const Wall& one, const Wall& other) {
    const auto bytes = [](const Wall& wall) {
        std::vector<std::byte> all;
        ByteWriter out(all);
        write_body(wall, [&out](const auto& value) { out.put(value); });
        return all;
    };
    return bytes(one) == bytes(other);
}

}  // namespace grainsweep::dem
