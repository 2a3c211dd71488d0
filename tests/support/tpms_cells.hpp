// The powder of Gupta, Ness & Haeri in a cell, as a setup of the engine without the scene around it.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"
#include "tests/support/tpms_filling.hpp"

#include <functional>
#include <memory>

namespace grainsweep::tests {

inline constexpr double cell_diameter = 45e-6;  ///< m

/// Mobile and frozen spheres of `filling` in a cell of `edge` diameters with the column stress of the full one, gravity
/// 9.81 x 100/edge, step 1 us; cohesion in J/m3. floor: how far below the cell the domain goes on, in edges.
[[nodiscard]] dem::Setup cell_of(const particles::TpmsFilling& filling, double edge, double cohesion, double floor);

/// A scene at its end, advanced in uneven slices of 37 to 459 us and after every fourth made anew from its checkpoint;
/// the last of these is left in `checkpoint`.
[[nodiscard]] std::unique_ptr<Scene> run_in_slices(const std::function<std::unique_ptr<Scene>()>& make,
                                                   Bytes& checkpoint);

}  // namespace grainsweep::tests
