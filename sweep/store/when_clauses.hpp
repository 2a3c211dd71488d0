// The `when` conditions of factors: compiled, and put into an order in which each finds what it needs.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace grainsweep::store {

/// Compiles the conditions of the factors, each after the conditions of the factors that it reads. Throws WrongQuestion
/// where one cannot be read, needs itself, reads an expression or no factor at all.
[[nodiscard]] std::vector<campaign::WhenClause> when_clauses(const campaign::ParameterSpace& space);

}  // namespace grainsweep::store
