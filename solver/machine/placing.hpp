// Places of the particles of a filling: on a lattice, at random, as rain, packed.
#pragma once

#include "solver/machine/filling.hpp"

#include <vector>

namespace grainsweep::machine {

/// Returns the centres of a filling's particles, in their order: completely in the region and the domain, without
/// touching a wall or each other. Throws std::invalid_argument with one sentence if they do not fit.
[[nodiscard]] std::vector<Vec3> places_of(const Spec& spec, const Fill& fill, const Draws& draws,
                                          const std::vector<Draws::Particle>& particles, const Obstacles& obstacles);
/// Throws like places_of() if a lattice has too few places, which does not depend on the seed.
void require_places(const Spec& spec);
/// Returns the diameter of the largest particles of a mix, m.
[[nodiscard]] double widest_in(const Spec& spec, const Mix& mix);

}  // namespace grainsweep::machine
