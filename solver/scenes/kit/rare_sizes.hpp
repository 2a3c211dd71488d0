// Warning about sizes that are too rare for the number of particles of a case.
#pragma once

#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <vector>

namespace grainsweep::kit {

/// Warns if fewer than three of `count` spheres are expected among the largest sizes with a tenth of the powder's
/// volume.
void warn_of_rare_sizes(std::vector<Warning>& warnings, const particles::SizeDistribution& sizes, double diameter,
                        double count);

}  // namespace grainsweep::kit
