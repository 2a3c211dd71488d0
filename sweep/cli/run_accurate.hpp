// `run` of a campaign with an error goal ("accuracy" as an object).
//
// Each setting is a campaign beside NAME in the same database, with the first points of the same design and the same
// seeds: NAME_fast, NAME_balanced, ..., NAME_reference. A pilot of two points per sequence chooses the setting of NAME,
// which has most cases. Then cases are added to NAME and NAME_reference until the error from numerics and statistics is
// within the tolerance at two checks in a row. If a check finds `reference` alone cheaper than further pairs, only
// NAME_reference continues. The next cases depend only on stored values and predicted costs. So the same cases run
// after an interruption, and with one worker or many.
#pragma once

#include "sweep/cli/run_campaign.hpp"

namespace grainsweep::cli {

[[nodiscard]] RunReport run_accurate(const RunRequest& request);

}  // namespace grainsweep::cli
