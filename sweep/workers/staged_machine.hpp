// How workers learn of a machine: its definition and the contents of its files lie among the shared starting states.
#pragma once

#include "solver/scenes/scene.hpp"

#include <string_view>

namespace grainsweep::workers {

/// Puts the machine of a scene where workers find it; nothing where the scene is no machine. Throws BrokenWorld.
void stage_machine(std::string_view scene, Artefacts& artefacts);
/// Makes the machine of a scene known to this process, where it is staged as it was written.
void enter_staged_machine(std::string_view scene, Artefacts& artefacts);

}  // namespace grainsweep::workers
