// `accuracy` in every form: what each setting costs, its bias, and which is the cheapest within a tolerance.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/accuracy.hpp"

#include <span>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// `observables`: the judged ones, shown as text; empty: all. Rows and value have all.
[[nodiscard]] Document accuracy_document(std::string_view campaign, std::span<const study::NumericsCost> costs,
                                         std::span<const std::string> observables, double tolerance);

}  // namespace grainsweep::report
