// `run` and `calibrate`: one campaign, or the campaigns of a calibration's experiments in turn.
#pragma once

#include "sweep/cli/run_campaign.hpp"

namespace grainsweep::cli {

/// Runs the campaign of the file. For a calibration with several experiments it runs each in turn, as far as the
/// answers of the others permit, until none has new points. A campaign with an error goal runs as in run_accurate.hpp.
/// A finished calibration writes NAME_posterior.csv beside the database; its report ends with the verdict, and its exit
/// code is 1 if a measurement is not reproduced.
[[nodiscard]] RunReport run_file(const RunRequest& request);

}  // namespace grainsweep::cli
