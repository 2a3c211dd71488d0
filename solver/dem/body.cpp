#include "solver/dem/body.hpp"

#include "solver/dem/engine.hpp"

#include <algorithm>

namespace grainsweep::dem {

using namespace geometry;

namespace {

/// q + span/2 w q, of unit length.
Quaternion advanced(const Quaternion& q, const Vec3& spin, const Quaternion& at, double half) {
    const Quaternion rate = product({0, spin[0], spin[1], spin[2]}, at);
    return normalised({q[0] + half * rate[0], q[1] + half * rate[1], q[2] + half * rate[2], q[3] + half * rate[3]});
}

}  // namespace

double reach_of(const BodyShape& shape) {
    double farthest = 0;
    for (const auto& member : shape.members) farthest = std::max(farthest, norm(member.place) + member.radius);
    return farthest;
}

std::vector<Sphere> members_of(const BodyShape& shape, const Body& body, std::uint8_t kind) {
    const Axes axes = axes_of(body.orientation);
    std::vector<Sphere> spheres;
    for (const auto& member : shape.members) {
        const Vec3 lever = in_space(axes, body.scale * member.place);
        spheres.push_back({.position = body.position + lever,
                           .velocity = body.velocity + cross(body.angular_velocity, lever),
                           .angular_velocity = body.angular_velocity,
                           .radius = body.scale * member.radius,
                           .kind = kind});
    }
    return spheres;
}

Vec3 turn(Quaternion& q, const Vec3& momentum, const Vec3& inertia, double span) {
    const Vec3 before = spin_of(momentum, axes_of(q), inertia);
    const Quaternion whole = advanced(q, before, q, span / 2);
    const Quaternion middle = advanced(q, before, q, span / 4);
    const Vec3 spin = spin_of(momentum, axes_of(middle), inertia);
    const Quaternion halves = advanced(middle, spin, middle, span / 4);
    q = normalised(
        {2 * halves[0] - whole[0], 2 * halves[1] - whole[1], 2 * halves[2] - whole[2], 2 * halves[3] - whole[3]});
    return spin;
}

}  // namespace grainsweep::dem
