// Compiled `when` conditions of factors, each after the conditions on which it depends.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace grainsweep::store {

/// Compiles the conditions of the factors, each after the conditions of the factors that it reads. Throws InputError
/// if one is invalid, depends on itself, or reads an expression or no factor at all.
[[nodiscard]] std::vector<campaign::WhenClause> when_clauses(const campaign::ParameterSpace& space);

}  // namespace grainsweep::store
