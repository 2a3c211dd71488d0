// Output of `accuracy` in all forms: cost and bias of each setting, and the cheapest setting within a tolerance.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/accuracy.hpp"

#include <span>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// Returns the document. `observables`: the judged ones, shown in the text; empty: all. Rows and JSON always have all.
[[nodiscard]] Document accuracy_document(std::string_view campaign, std::span<const study::NumericsCost> costs,
                                         std::span<const std::string> observables, double tolerance);

}  // namespace grainsweep::report
