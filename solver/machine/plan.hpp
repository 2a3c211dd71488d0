// What a machine will probably take, and what its user should know before it runs.
#pragma once

#include "solver/machine/spec.hpp"
#include "solver/scenes/scene.hpp"

#include <vector>

namespace grainsweep::machine {

/// Particles that fillings and feeds ask for, times steps of all phases; phases that may end early count for half.
/// Expected length, s: what the phase says, or half of what it lasts at most where it may end sooner.
[[nodiscard]] double length_of(const Phase& phase);
[[nodiscard]] CostEstimate cost_of(const Spec& spec);
/// Warns of particles too soft for the fall and of feeds that cannot keep up.
[[nodiscard]] std::vector<Warning> warnings_of(const Spec& spec);

}  // namespace grainsweep::machine
