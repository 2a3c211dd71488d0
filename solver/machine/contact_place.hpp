// Places of contacts, and their particles.
#pragma once

#include "solver/machine/probe.hpp"

#include <algorithm>

namespace grainsweep::machine {

/// Returns the index of a particle in the state of the sight.
[[nodiscard]] inline std::size_t place_of(const Sight& sight, std::int32_t id) {
    return static_cast<std::size_t>(std::ranges::lower_bound(sight.state.id, id) - sight.state.id.begin());
}

/// Returns the point of a contact at distance R - d/2 from the centre of its first particle; for a wall, the point of
/// its surface.
[[nodiscard]] inline Vec3 contact_point(const Sight& sight, const dem::ContactForce& contact) {
    using namespace geometry;
    const std::size_t i = place_of(sight, contact.first);
    const double arm = sight.state.radius[i] - (contact.second < 0 ? contact.overlap : contact.overlap / 2);
    const Vec3 x = sight.state.position[i] - arm * contact.normal;
    return x + sight.domain.wrapping(x);
}

}  // namespace grainsweep::machine
