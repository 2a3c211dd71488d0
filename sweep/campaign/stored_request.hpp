// Design request and parameter space of a stored campaign.
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/designs/design.hpp"

#include <optional>
#include <vector>

namespace grainsweep::campaign {

/// Returns options, levels and ranges; listed rows are not included, because they are in the places of the campaign.
/// Throws std::logic_error for an unknown design.
[[nodiscard]] designs::DesignRequest request_of(const Identity& identity);
/// Returns the fixed values of the scene's parameters, without expressions.
[[nodiscard]] Inputs fixed_values(const Identity& identity, const SceneInfo& scene);
/// Returns the parameter space of a stored campaign, without compiled `when` clauses; empty for an unknown scene.
[[nodiscard]] std::optional<ParameterSpace> space_of(const Identity& identity);

}  // namespace grainsweep::campaign
