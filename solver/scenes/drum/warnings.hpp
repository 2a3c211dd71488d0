// What a user must know before asking a rotating_drum case whose inputs make little sense together.
#pragma once

#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::drum {

/// At most one warning of a kind. Throws std::invalid_argument where the inputs are impossible together.
[[nodiscard]] std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files);

}  // namespace grainsweep::drum
