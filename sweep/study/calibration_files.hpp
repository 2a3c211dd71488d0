// Files that a calibration writes for other campaigns: the draws of its posterior, and a powder.
#pragma once

#include "sweep/campaign/powder_result.hpp"
#include "sweep/study/calibration.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::study {

/// Returns the posterior's draws as CSV: a header with the factors' names and one row per draw, in SI units. Empty
/// without a posterior.
[[nodiscard]] std::string posterior_csv(const designs::Calibration& found);

/// Returns the calibrated properties at the draw of highest density, and the measurements. Factors that are no property
/// of a powder are left out. Absent if no factor is such a property, or without a posterior.
[[nodiscard]] std::optional<campaign::PowderResult> powder_result(const CalibrationReport& report,
                                                                  std::string_view posterior_file);

}  // namespace grainsweep::study
