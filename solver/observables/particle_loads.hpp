// Contact loads of each particle, for pictures and force chains.
#pragma once

#include "solver/dem/engine.hpp"

#include <span>
#include <vector>

namespace grainsweep::observables {

/// Loads in the order of the state.
struct ParticleLoads {
    std::vector<dem::Vec3> force;      ///< N, sum over the contacts; for a sphere at rest it balances the weight
    std::vector<double> largest;       ///< N, largest magnitude of a single contact's force
    std::vector<double> overlap;       ///< m, largest of its contacts
    std::vector<double> coordination;  ///< number of contacts, including walls
};

/// Returns the loads from the contacts of an engine and the state at the same time. Frozen spheres get the loads of
/// mobile ones.
[[nodiscard]] ParticleLoads particle_loads(const dem::State& state, std::span<const dem::ContactForce> contacts);

}  // namespace grainsweep::observables
