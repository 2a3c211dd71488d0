// Warnings about tpms_discharge cases with questionable combinations of inputs.
#pragma once

#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep {

/// Returns at most one warning of each kind. Throws std::invalid_argument if the combination of inputs is impossible.
[[nodiscard]] std::vector<Warning> tpms_discharge_warnings(const Inputs& inputs, const Files&);

}  // namespace grainsweep
