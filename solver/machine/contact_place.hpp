// Places of contacts, and their particles.
#pragma once

#include "solver/machine/probe.hpp"

#include <algorithm>

namespace grainsweep::machine {

inline constexpr Field contact_in_option =
    option("in", Field::Kind::region, "", "the region in which contacts count; default: everywhere");

/// Returns the index of a sphere in the spheres of the frame.
[[nodiscard]] inline std::size_t place_of(const Frame& frame, std::int32_t id) {
    return static_cast<std::size_t>(std::ranges::lower_bound(frame.spheres().id, id) - frame.spheres().id.begin());
}
/// Returns the index of the particle that a sphere is, or is a member of.
[[nodiscard]] inline std::size_t particle_place_of(const Frame& frame, std::int32_t id) {
    const auto& ids = frame.state.id;
    return static_cast<std::size_t>(std::ranges::lower_bound(ids, frame.particle_of(id)) - ids.begin());
}

/// Returns the point of a contact at distance R - d/2 from the centre of its first particle; for a wall, the point of
/// its surface.
[[nodiscard]] inline Vec3 contact_point(const Frame& frame, const dem::ContactForce& contact) {
    using namespace geometry;
    const std::size_t i = place_of(frame, contact.first);
    const double arm = frame.spheres().radius[i] - (contact.second < 0 ? contact.overlap : contact.overlap / 2);
    const Vec3 x = frame.spheres().position[i] - arm * contact.normal;
    return x + frame.domain.wrapping(x);
}

}  // namespace grainsweep::machine
