// Numbers with errors and names with units, as text.
#pragma once

#include "stats/sensitivity.hpp"

#include <string>
#include <string_view>

namespace grainsweep::study {

/// Returns a text such as "0.2702 ± 0.0011": the error with two digits, the value to the same decimal place. Without an
/// error: the value with 5 digits.
/// An error of rounding only (below 1e-12 of the value) is 0. NaN: "-".
[[nodiscard]] std::string with_error(double value, double error);

/// Returns an index and its error as text. Indices below 1e-9 are rounding errors and are shown as 0.
[[nodiscard]] std::string index_text(const stats::SensitivityIndex& index);

/// Returns a text such as "gap (m)". A pure number and a word have no unit.
[[nodiscard]] std::string with_unit(std::string_view name, std::string_view unit);

}  // namespace grainsweep::study
