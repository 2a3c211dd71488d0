// Figures with their errors and names with their units, as a reader quotes them.
#pragma once

#include "stats/sensitivity.hpp"

#include <string>
#include <string_view>

namespace grainsweep::study {

/// "0.2702 ± 0.0011": the error to two digits, the value to the same place. No error: the value to 5 digits.
/// An error of rounding only (below 1e-12 of the value) is 0. NaN: "-".
[[nodiscard]] std::string with_error(double value, double error);

/// An index and its error; below 1e-9 rounding is all there is, and it is shown as 0.
[[nodiscard]] std::string index_text(const stats::SensitivityIndex& index);

/// "gap (m)"; a pure number and a word have no unit.
[[nodiscard]] std::string with_unit(std::string_view name, std::string_view unit);

}  // namespace grainsweep::study
