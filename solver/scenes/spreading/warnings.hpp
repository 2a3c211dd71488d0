// Warnings about powder_spreading cases with questionable combinations of inputs.
#pragma once

#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::spreading {

/// Returns at most one warning of each kind. Throws std::invalid_argument if the combination of inputs is impossible.
[[nodiscard]] std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files);

}  // namespace grainsweep::spreading
