// Random cases of a few spheres in every granular scene, for checks of the engines' soundness.
#pragma once

#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {

struct FewSpheres {
    Inputs inputs;
    std::uint64_t seed = 0;
    double step_limit = 0;  ///< shorter of the Rayleigh time and the Hertz contact time that the scene judges by, s
};

/// "powder_spreading", "tpms_discharge", "hopper", "heap", "rotating_drum".
[[nodiscard]] const std::vector<std::string_view>& granular_scenes();

/// Case number `number` of the scene: 1 to 20 spheres; restitution, friction, rolling, cohesion, sizes, laws,
/// stiffness and precision at random within their bounds, a restitution of 1 in every fourth. `step` is the time step
/// over the limit.
[[nodiscard]] FewSpheres few_spheres(std::string_view scene, std::uint64_t number, double step);

struct Fate {
    std::string fault;                          ///< why it is unstable; empty: it is not
    std::string refused;                        ///< why it cannot be made; empty: it can
    double most_kinetic = 0, last_kinetic = 0;  ///< J, of looks every hundredth of the case
};
[[nodiscard]] Fate fate_of(std::string_view scene, const FewSpheres& question);

}  // namespace grainsweep::tests
