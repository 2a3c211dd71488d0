// How workers learn of what no file of the campaign's folder holds: definitions of machines with the contents of their
// files, and files that the program made. They lie among the shared starting states.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"

namespace grainsweep::workers {

/// Puts the campaign's machine and the files that the program made where workers find them. Throws BrokenWorld.
void stage_campaign(const campaign::Campaign& campaign, Artefacts& artefacts);
/// Makes what a case needs of these known to this process, where it is staged as it was written.
void enter_staged(const campaign::Case& question, Artefacts& artefacts);

}  // namespace grainsweep::workers
