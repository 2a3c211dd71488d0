// Moments of the setting `reference` from a campaign with an error goal: rows for people, JSON for programs.
#pragma once

#include "sweep/report/table.hpp"
#include "sweep/study/corrected.hpp"

namespace grainsweep::report {

/// One row per statistic: at the chosen setting, corrected, and the parts of the error relative to it.
[[nodiscard]] store::Table corrected_table(const study::Corrected& corrected);

/// {"observable", "setting", "cases", "pairs", "tolerance", "within", "core_seconds", "alone_core_seconds",
/// "statistics": {"mean": {"value", "error", "numerics", "statistics", "uncorrected"}, ...}}, errors in the unit of the
/// observable.
[[nodiscard]] Json corrected_json(const study::Corrected& corrected);

}  // namespace grainsweep::report
