// Summary of a run on standard output.
#pragma once

#include "sweep/cli/run_campaign.hpp"
#include "sweep/report/table.hpp"

namespace grainsweep::cli {

/// Prints the data of a finished run that a calling program needs; the results are in the database. `all`: the text has
/// every observable and moment.
void show_run(const RunReport& run, report::Format format, bool all);

}  // namespace grainsweep::cli
