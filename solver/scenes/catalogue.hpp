// Functions that describe the scenes, one line per scene.
#pragma once

#include "solver/scenes/scene.hpp"

namespace grainsweep {

[[nodiscard]] SceneInfo rehearsal_scene();
[[nodiscard]] SceneInfo thermovibration_scene();

}  // namespace grainsweep
