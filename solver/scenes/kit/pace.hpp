// Estimates of the cost of a DEM case, from seconds per particle and step of a dense, sheared powder on one core.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep::kit {

/// Returns the factor by which rolling springs with memory lengthen a step.
[[nodiscard]] double slower_by_rolling(const dem::Material& material);
/// Returns the cost of a case with these numbers of mobile and frozen spheres.
[[nodiscard]] CostEstimate estimate(const dem::Method& method, const dem::Material& material, double mobile,
                                    double steps, double frozen = 0);

/// Returns the largest overlap of two equal spheres that collide at a speed, divided by their diameter (Hertz 1882):
/// d = (15 m* v^2/(16 E* sqrt(R*)))^(2/5).
[[nodiscard]] double impact_overlap(const dem::Material& material, double diameter, double speed);

}  // namespace grainsweep::kit
