// What warnings say of powder that falls into its container.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::kit {

/// Of a settle_time, s, that is shorter than the fall from the height of the loose filling, m, at the gravity, m/s2.
void warn_of_short_settling(std::vector<Warning>& warnings, double settle_time, double height, double gravity);

/// Of particles of this diameter, m, so soft that falling from the height, m, they overlap by more than a tenth of it.
void warn_of_softness(std::vector<Warning>& warnings, const dem::Material& material, double diameter, double height,
                      double gravity);

}  // namespace grainsweep::kit
