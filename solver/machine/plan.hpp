// Expected cost of a machine, and warnings before it runs.
#pragma once

#include "solver/machine/spec.hpp"
#include "solver/scenes/scene.hpp"

#include <vector>

namespace grainsweep::machine {

/// Returns the expected length of a phase, s: as stated, else half of its longest duration if it may end early.
[[nodiscard]] double length_of(const Phase& phase);
/// Returns the expected cost: particles of the fillings and feeds, times the steps of all phases.
[[nodiscard]] CostEstimate cost_of(const Spec& spec);
/// Returns warnings about particles that are too soft for the fall, and about feeds that cannot reach their rate.
[[nodiscard]] std::vector<Warning> warnings_of(const Spec& spec);

}  // namespace grainsweep::machine
