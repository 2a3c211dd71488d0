// Calibration with several experiments: one campaign per experiment; all share factors, waves and posterior.
//
// The campaign NAME_EXPERIMENT runs the settings of every wave in its experiment. Its design's options contain the
// targets and factors of all experiments, so each of these campaigns can compute the waves from the answers of all.
#pragma once

#include "sweep/campaign/identity.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Returns the name of the campaign that runs another experiment of the same calibration.
[[nodiscard]] std::string name_beside(const Identity& identity, std::string_view experiment);
/// Returns the name in the campaign file: the name of the campaign without its experiment.
[[nodiscard]] std::string name_in_file(const Identity& identity);
/// Returns the experiments of all targets, each once, in the order of the targets; empty: a single campaign.
[[nodiscard]] std::vector<std::string> experiments_of(const Identity& identity);
/// Returns whether this campaign shows the results of all experiments: the first one, and every single campaign.
[[nodiscard]] bool shows_findings(const Identity& identity);

}  // namespace grainsweep::campaign
