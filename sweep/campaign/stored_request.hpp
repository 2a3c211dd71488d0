// The design of a stored campaign as it was asked: what an archive keeps as text, in the types of a request.
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/designs/design.hpp"

#include <vector>

namespace grainsweep::campaign {

/// Options, levels and ranges; listed rows are left out, they stand in the places of the campaign. Throws
/// std::logic_error for a design that this program does not know.
[[nodiscard]] designs::DesignRequest request_of(const Identity& identity);
/// The fixed values of parameters of the scene, without those that follow from an expression.
[[nodiscard]] Inputs fixed_values(const Identity& identity, const SceneInfo& scene);
/// The factors as they were asked; levels as text.
[[nodiscard]] std::vector<Factor> factors_asked(const Identity& identity);

}  // namespace grainsweep::campaign
