// `run` and `calibrate`: one campaign, or one of each experiment of a calibration in turn.
#pragma once

#include "sweep/cli/run_campaign.hpp"

namespace grainsweep::cli {

/// Runs the campaign of the file. Of a calibration over several experiments it runs each in turn, as far as the answers
/// of the others allow, until none brings new points; of a campaign with an error goal as run_accurate.hpp describes. A
/// calibration that has ended writes NAME_posterior.csv beside the database; its report ends with the verdict, and its
/// exit code is 1 where a measurement is not reproduced.
[[nodiscard]] RunReport run_file(const RunRequest& request);

}  // namespace grainsweep::cli
