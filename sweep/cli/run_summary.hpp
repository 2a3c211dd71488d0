// What a run ends with on standard output.
#pragma once

#include "sweep/cli/run_campaign.hpp"
#include "sweep/report/table.hpp"

namespace grainsweep::cli {

/// What a program wants to know of a finished run; the science is in the database.
void show_run(const RunReport& run, report::Format format);

}  // namespace grainsweep::cli
