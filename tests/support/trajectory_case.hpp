// One case of the trajectory reference.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// Spheres, material, floor and blade of a case of trajectories/cases.json, in a room of two metres.
[[nodiscard]] dem::Setup setup_of(const nlohmann::json& reference_case);

}  // namespace grainsweep::tests
