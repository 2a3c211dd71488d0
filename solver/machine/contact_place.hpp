// Places of contacts, and their particles.
#pragma once

#include "solver/machine/probe.hpp"

#include <algorithm>

namespace grainsweep::machine {

/// Returns the index of a particle in the state of the frame.
[[nodiscard]] inline std::size_t place_of(const Frame& frame, std::int32_t id) {
    return static_cast<std::size_t>(std::ranges::lower_bound(frame.state.id, id) - frame.state.id.begin());
}

/// Returns the point of a contact at distance R - d/2 from the centre of its first particle; for a wall, the point of
/// its surface.
[[nodiscard]] inline Vec3 contact_point(const Frame& frame, const dem::ContactForce& contact) {
    using namespace geometry;
    const std::size_t i = place_of(frame, contact.first);
    const double arm = frame.state.radius[i] - (contact.second < 0 ? contact.overlap : contact.overlap / 2);
    const Vec3 x = frame.state.position[i] - arm * contact.normal;
    return x + frame.domain.wrapping(x);
}

}  // namespace grainsweep::machine
