// A calibration over several experiments: one campaign of each, and all of them share factors, waves and posterior.
//
// The campaign NAME_EXPERIMENT runs the settings of every wave in its experiment. Its design's options hold the targets
// and factors of all experiments, so that each of these campaigns can form the waves from the answers of all.
#pragma once

#include "sweep/campaign/identity.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// The campaign that runs another experiment of the same calibration.
[[nodiscard]] std::string name_beside(const Identity& identity, std::string_view experiment);
/// Returns the name in the campaign file: the campaign's without its experiment.
[[nodiscard]] std::string name_in_file(const Identity& identity);
/// The experiments whose targets are calibrated to, each once, in the order of the targets; empty: one campaign alone.
[[nodiscard]] std::vector<std::string> experiments_of(const Identity& identity);
/// Whether this campaign shows what all of them have found: the first, and every campaign that stands alone.
[[nodiscard]] bool shows_findings(const Identity& identity);

}  // namespace grainsweep::campaign
