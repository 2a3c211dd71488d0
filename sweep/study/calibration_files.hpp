// What a calibration leaves for other campaigns: the draws of its posterior, and a powder.
#pragma once

#include "sweep/study/calibration.hpp"

#include <string>
#include <string_view>

namespace grainsweep::study {

/// Returns the posterior's draws as CSV: a header of the factors' names and a row for each draw, in SI units. Empty
/// where there is no posterior.
[[nodiscard]] std::string posterior_csv(const designs::Calibration& found);

/// Returns a powder file: the calibrated properties of a powder at the draw of highest density, the measurements, and
/// the name of the posterior's file. Factors that are no property of a powder are left out; empty where none is one, or
/// there is no posterior.
[[nodiscard]] std::string powder_json(const CalibrationReport& report, std::string_view name,
                                      std::string_view posterior_file);

}  // namespace grainsweep::study
