// Reading of a contact of the present state: its touch at the velocities of the laws and at full-step velocities, and
// the response of the laws.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/laws/any_contact.hpp"
#include "solver/dem/network.hpp"

#include <cmath>

namespace grainsweep::dem {

/// Velocities of one particle.
struct Velocities {
    Vec3 velocity{};  ///< m/s
    Vec3 spin{};      ///< rad/s
};

/// Velocities of i relative to its partner.
struct RelativeMotion {
    Vec3 velocity{};   ///< v_i - v_j, m/s
    Vec3 surface{};    ///< (R_i - d/2) w_i + (R_j - d/2) w_j, m/s
    Vec3 turning{};    ///< w_i - w_j, rad/s
    double terms = 0;  ///< sum of the sizes of the terms of v . n, of which its rounding error is a share, m/s
};

/// Returns the sum of the sizes of the terms of u . n and v . n.
[[nodiscard]] inline double sizes_along(const Vec3& n, const Vec3& u, const Vec3& v) {
    double sum = 0;
    for (std::size_t a = 0; a < 3; ++a) sum += std::abs(n[a]) * (std::abs(u[a]) + std::abs(v[a]));
    return sum;
}

[[nodiscard]] inline RelativeMotion relative(const Touch<Partner::particle>& t, const Velocities& i,
                                             const Velocities& j) {
    using namespace geometry;
    return {i.velocity - j.velocity, (t.radius_i - t.overlap / 2) * i.spin + (t.radius_j - t.overlap / 2) * j.spin,
            i.spin - j.spin, sizes_along(t.normal, i.velocity, j.velocity)};
}
[[nodiscard]] inline RelativeMotion relative(const Touch<Partner::wall>& t, const Velocities& i, const Vec3& wall) {
    using namespace geometry;
    return {i.velocity - wall, (t.radius_i - t.overlap / 2) * i.spin, i.spin, sizes_along(t.normal, i.velocity, wall)};
}

/// Returns the touch at these velocities.
template <Partner partner>
[[nodiscard]] Touch<partner> moving(Touch<partner> t, const RelativeMotion& m) {
    using namespace geometry;
    t.normal_velocity = dot(m.velocity, t.normal);
    t.slip = m.velocity - t.normal_velocity * t.normal - cross(m.surface, t.normal);
    t.turning = m.turning;
    return t;
}
/// Returns the touch as in the last step, which has cut the memories since. `rounding`: relative rounding error of its
/// forces.
template <Partner partner>
[[nodiscard]] Touch<partner> as_in_step(const Touch<partner>& t, const RelativeMotion& before, double rounding) {
    Touch<partner> seen = moving(t, before);
    seen.rounding = rounding;
    seen.rounded_speed = before.terms;
    seen.time_step = 0;
    return seen;
}

/// Returns a contact as a bond of the network (network.hpp), of the bodies with these numbers. `slides`: a contact that
/// the last step has cut has no tangential spring. `rounding`: as of as_in_step().
template <Partner partner>
[[nodiscard]] Bond bond_of(const AnyContact& laws, const Touch<partner>& t, const double* memory, std::uint64_t key,
                           std::int32_t first, std::int32_t second, bool slides, double rounding) {
    Bond bond{.key = key,
              .first = first,
              .second = second,
              .normal = t.normal,
              .lever_first = t.radius_i - t.overlap / 2,
              .lever_second = t.radius_j - t.overlap / 2,
              .springs = laws.springs(t)};
    if (t.apart) bond.springs = {};
    if (slides && bond.springs.tangential > 0 && laws.respond(as_in_step(t, RelativeMotion{}, rounding), memory).slides)
        bond.springs.tangential = bond.springs.tangential_damper = 0;
    return bond;
}

/// Returns the contact: its force at `seen`, all other members at `now`.
template <Partner partner>
[[nodiscard]] ContactForce read_contact(const AnyContact& laws, const Touch<partner>& seen, const Touch<partner>& now,
                                        const double* memory, std::int32_t first, std::int32_t second) {
    using namespace geometry;
    const auto r = laws.respond(seen, memory);
    return {.first = first,
            .second = second,
            .overlap = now.overlap,
            .normal = now.normal,
            .normal_force = r.normal,
            .tangential_force = -r.resistance,
            .rolling_moment = -r.rolling,
            .slip = now.slip,
            .slides = r.slides || r.resistance == Vec3{},
            .normal_power = -r.normal * now.normal_velocity,
            .tangential_power = dot(r.resistance, now.slip) + dot(r.rolling, now.turning),
            .stored = laws.energy(now, memory)};
}

}  // namespace grainsweep::dem
