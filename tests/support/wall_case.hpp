// One case of the reference of walls.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// A case of walls/cases.json or cases_exact.json: the sphere, its material, and the walls, planes, cylinders and cones
/// before meshes, in a room of the case's box. A cylinder that turns does so with the speed given for the
/// surface: where the reference means the speed at the sphere's centre, the two differ (its README, section 3).
[[nodiscard]] dem::Setup setup_of_wall_case(const nlohmann::json& reference_case);

/// Of one mesh of a case.
[[nodiscard]] geometry::Mesh mesh_of(const nlohmann::json& mesh);
[[nodiscard]] std::vector<geometry::Motion> motions_of(const nlohmann::json& mesh);

/// All cases of a file of the reference, by name.
[[nodiscard]] nlohmann::json wall_cases(const std::string& file);

/// Largest differences of the one sphere from a table of the reference, over its rows.
struct Deviation {
    double position = 0, velocity = 0, spin = 0;  ///< over the diameter, the largest speed, that over the radius
    std::string fault;
    [[nodiscard]] double largest() const { return std::max({position, velocity, spin}); }
};
/// `table`: the name of a CSV file of the reference without its ending.
[[nodiscard]] Deviation deviation(const std::string& table, const dem::Setup& setup, const dem::Method& method);

}  // namespace grainsweep::tests
