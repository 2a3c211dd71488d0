// What a user must know before asking a tpms_discharge case whose inputs make little sense together.
#pragma once

#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep {

/// At most one warning of a kind. Throws std::invalid_argument where the inputs are impossible together.
[[nodiscard]] std::vector<Warning> tpms_discharge_warnings(const Inputs& inputs, const Files&);

}  // namespace grainsweep
