// Small setups that exercise a DEM engine, deterministic.
#pragma once

#include <cstdint>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// Material of the spreading study.
[[nodiscard]] dem::Material steel_like();

/// `per_side`^3 spheres of diameter about 1 mm on a jittered lattice, thrown about at up to `speed`; radii spread by
/// +-`spread`. Periodic cube a little larger than the lattice, no walls.
[[nodiscard]] dem::Setup thrown_lattice(int per_side, double speed, double spread, std::uint64_t seed);

/// The same in an open box of five planes, the bottom one tilted a little, with gravity.
[[nodiscard]] dem::Setup boxed_lattice(int per_side, double speed, double spread, std::uint64_t seed);

/// Largest difference of positions, over the largest diameter, of the particles both states hold; wraps ignored.
[[nodiscard]] double position_difference(const dem::State& a, const dem::State& b, const dem::Domain& domain,
                                         double diameter);
/// Largest difference of velocities, m/s.
[[nodiscard]] double velocity_difference(const dem::State& a, const dem::State& b);
/// Largest difference of angular velocities, rad/s.
[[nodiscard]] double spin_difference(const dem::State& a, const dem::State& b);

}  // namespace grainsweep::tests
