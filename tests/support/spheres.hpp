// Small DEM setups and what can be said of them without an engine.
#pragma once

#include "solver/dem/engine.hpp"

#include <cstdint>

namespace grainsweep::tests {

/// A domain too large to matter, no gravity, E 21 MPa, nu 0.3, density 7980, restitution 0.5, friction 0.2.
[[nodiscard]] dem::Setup empty_space();

/// `n` spheres on a jittered lattice inside a closed box of six frictional planes (edge: enough for a loose gas),
/// random velocities of up to `speed` per component. largest_ratio: radii from 1 mm down to 1 mm / ratio, evenly in
/// logarithm.
[[nodiscard]] dem::Setup boxed_gas(std::size_t n, double speed, double largest_ratio, std::uint64_t seed);

/// Layers of 6 x 6 spheres of 2.8 to 3.2 mm over 20 x 20 mm above the floor z = 0, about to fall. No domain yet.
[[nodiscard]] dem::Setup bed_on_floor(int layers);

[[nodiscard]] double mass(const dem::Setup& setup, double radius);
[[nodiscard]] double kinetic_energy(const dem::Setup& setup, const dem::State& state);  ///< with rotation, J
[[nodiscard]] bool finite(const dem::State& state);

/// The default method with this precision.
[[nodiscard]] dem::Method method(dem::Method::Precision precision, int threads = 1);
/// The state of an engine.
[[nodiscard]] dem::State state_of(const dem::Engine& engine);

}  // namespace grainsweep::tests
