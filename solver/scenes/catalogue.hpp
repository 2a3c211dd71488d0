// One line per scene: the function that describes it.
#pragma once

#include "solver/scenes/scene.hpp"

namespace grainsweep {

<<<<<<< HEAD
[[nodiscard]] SceneInfo tpms_discharge_scene();
=======
[[nodiscard]] SceneInfo powder_spreading_scene();
>>>>>>> main
[[nodiscard]] SceneInfo rehearsal_scene();

}  // namespace grainsweep
