// What a user must know before asking a thermovibration case whose inputs make little sense together.
#pragma once

#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::thermovibration {

/// At most one warning of a kind. Throws std::invalid_argument where the inputs are impossible together.
[[nodiscard]] std::vector<Warning> warnings_of(const Inputs& inputs, const Files&);

}  // namespace grainsweep::thermovibration
