// `run` of a campaign that says what its answer may be off by ("accuracy" as an object).
//
// Each setting is a campaign beside NAME in the same database, over the first points of the same design with the same
// seeds: NAME_fast, NAME_balanced, ..., NAME_reference. NAME itself has the many cases, at the setting that a pilot of
// two points a sequence chose. Then cases are added to NAME and NAME_reference until numerics and statistics together
// are within the tolerance at two checks in a row. Where a check finds `reference` alone cheaper than further pairs,
// NAME_reference alone goes on. What comes next follows from stored values and predicted costs
// alone: interrupted, resumed, with one worker or many, the same cases run.
#pragma once

#include "sweep/cli/run_campaign.hpp"

namespace grainsweep::cli {

[[nodiscard]] RunReport run_accurate(const RunRequest& request);

}  // namespace grainsweep::cli
