// Where the particles of a filling lie: on a lattice, at random, as rain, packed.
#pragma once

#include "solver/machine/filling.hpp"

#include <vector>

namespace grainsweep::machine {

/// Centres of a filling's particles, in their order: wholly in the region and the domain, touching no wall and none
/// of the others. Throws std::invalid_argument with one sentence where they do not fit.
[[nodiscard]] std::vector<Vec3> places_of(const Spec& spec, const Fill& fill, const Draws& draws,
                                          const std::vector<Draws::Particle>& particles, const Obstacles& obstacles);
/// Throws as the filling of a case would where a lattice has too few places: they do not depend on the seed.
void require_places(const Spec& spec);
/// Diameter of the largest particles of a mix, m.
[[nodiscard]] double widest_in(const Spec& spec, const Mix& mix);

}  // namespace grainsweep::machine
