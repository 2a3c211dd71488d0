// What a calibration has found, as text, tables and JSON.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/calibration.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace grainsweep::report {

/// One sentence: where it stands.
[[nodiscard]] std::string calibration_line(const study::CalibrationReport& report);
[[nodiscard]] store::Table waves_table(const study::CalibrationReport& report);
[[nodiscard]] store::Table posterior_table(const study::CalibrationReport& report);
[[nodiscard]] store::Table targets_table(const study::CalibrationReport& report);
/// For the page: factors with their ranges, draws of the posterior and the settings run, in the factors' units.
[[nodiscard]] nlohmann::ordered_json page_of(const study::CalibrationReport& report);
/// Everything above for people.
[[nodiscard]] std::string calibration_text(const study::CalibrationReport& report);
[[nodiscard]] nlohmann::ordered_json to_json(const study::CalibrationReport& report);

}  // namespace grainsweep::report
