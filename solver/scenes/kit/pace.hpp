// What a DEM case costs, for estimates: seconds per particle and step of a dense, sheared powder on one core.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep::kit {

[[nodiscard]] double seconds_per_particle_step(const dem::Method& method);
/// Of a case with that many mobile and frozen spheres.
[[nodiscard]] CostEstimate estimate(const dem::Method& method, double mobile, double steps, double frozen = 0);

/// Largest overlap of two equal spheres that meet at a speed, over their diameter (Hertz 1882):
/// d = (15 m* v^2/(16 E* sqrt(R*)))^(2/5).
[[nodiscard]] double impact_overlap(const dem::Material& material, double diameter, double speed);

}  // namespace grainsweep::kit
