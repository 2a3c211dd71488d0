// Moments of the setting `reference` from a campaign with an error goal, as a table for people and JSON for programs.
#pragma once

#include "sweep/report/result.hpp"
#include "sweep/report/results/study.hpp"
#include "sweep/study/corrected.hpp"

namespace grainsweep::report {

/// Returns one row per statistic: value at the chosen setting, corrected value, and the parts of the relative error.
[[nodiscard]] store::Table corrected_table(const study::Corrected& corrected);

[[nodiscard]] Result<results::corrected> corrected_json(const study::Corrected& corrected);

}  // namespace grainsweep::report
