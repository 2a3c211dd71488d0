#include "solver/dem/body.hpp"

#include "solver/dem/engine.hpp"

#include <algorithm>

namespace grainsweep::dem {

using namespace geometry;

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

}  // namespace grainsweep::dem
