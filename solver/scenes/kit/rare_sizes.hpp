// Sizes that are too rare for the number of particles of a case.
#pragma once

#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::kit {

/// Warns where the largest sizes, which hold a tenth of the powder's volume, expect fewer than three of `count`
/// spheres.
void warn_of_rare_sizes(std::vector<Warning>& warnings, const particles::SizeDistribution& sizes, double diameter,
                        double count);

}  // namespace grainsweep::kit
