// Contact loads of each particle: for pictures, and for following chains of force.
#pragma once

#include "solver/dem/engine.hpp"

#include <span>
#include <vector>

namespace grainsweep::observables {

/// In the order of the state.
struct ParticleLoads {
    std::vector<dem::Vec3> force;      ///< N, sum over the contacts; zero for a sphere at rest but for its weight
    std::vector<double> largest;       ///< N, largest magnitude of a single contact's force
    std::vector<double> overlap;       ///< m, of the deepest contact
    std::vector<double> coordination;  ///< contacts, walls included
};

/// Contacts of an engine and the state it had with them. Frozen spheres bear what mobile ones press on them.
[[nodiscard]] ParticleLoads particle_loads(const dem::State& state, std::span<const dem::ContactForce> contacts);

}  // namespace grainsweep::observables
