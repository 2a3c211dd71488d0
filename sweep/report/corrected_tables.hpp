// Moments of the setting `reference` from a campaign with an error goal, as a table for people and JSON for programs.
#pragma once

#include "sweep/report/table.hpp"
#include "sweep/study/corrected.hpp"

namespace grainsweep::report {

/// Returns one row per statistic: value at the chosen setting, corrected value, and the parts of the relative error.
[[nodiscard]] store::Table corrected_table(const study::Corrected& corrected);

/// {"observable", "setting", "cases", "pairs", "tolerance", "within", "core_seconds", "alone_core_seconds",
/// "statistics": {"mean": {"value", "error", "numerics", "statistics", "uncorrected"}, ...}}, errors in the unit of the
/// observable.
[[nodiscard]] Json corrected_json(const study::Corrected& corrected);

}  // namespace grainsweep::report
