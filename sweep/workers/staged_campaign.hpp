// Data for workers that is in no file of the campaign's folder: definitions of machines with the contents of their
// files, and files that the program made. They are stored with the shared starting states.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"

namespace grainsweep::workers {

/// Stores the campaign's machine and the files that the program made where workers find them. Throws SystemError.
void stage_campaign(const campaign::Campaign& campaign, Artefacts& artefacts);
/// Registers the stored data that a case needs in this process, if it is unchanged.
void enter_staged(const campaign::Case& question, Artefacts& artefacts);

}  // namespace grainsweep::workers
