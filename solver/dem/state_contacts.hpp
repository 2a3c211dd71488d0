// Contacts of a state as positions and velocities show them: overlap and net normal force of every touching
// pair of equal spheres in which a mobile one takes part.
//
//     F = Hertz(d) - damping(v_n) - k_c A(d)            laws/hertz.hpp, laws/cohesion.hpp
//
// The tangential force is absent: it depends on the history of the contact, which a state does not tell. With
// friction mu the whole force is at most sqrt(1 + mu^2) times as large.
#pragma once

#include "solver/dem/engine.hpp"

#include <vector>

namespace grainsweep::dem {

struct StateContact {
    double overlap = 0;       ///< m
    double normal_force = 0;  ///< N; positive repels
};

/// In an order that depends on the positions only. All radii must be equal; open domain (no images).
[[nodiscard]] std::vector<StateContact> contacts_of(const State& state, const Material& material);

}  // namespace grainsweep::dem
