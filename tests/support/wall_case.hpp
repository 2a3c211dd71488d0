// One case of the reference of walls.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// The sphere, its material and the planes, cylinders and cones of a case of walls/cases.json or cases_exact.json, in a
/// room of the case's box; meshes are left to the caller. A cylinder that turns does so with the speed given for the
/// surface: where the reference means the speed at the sphere's centre, the two differ (its README, section 3).
[[nodiscard]] dem::Setup setup_of_wall_case(const nlohmann::json& reference_case);

/// The motions of one mesh of a case.
[[nodiscard]] std::vector<geometry::Motion> motions_of(const nlohmann::json& mesh);

}  // namespace grainsweep::tests
