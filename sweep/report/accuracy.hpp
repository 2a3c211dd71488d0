// Output of `accuracy` in all forms: cost and bias of each setting, and the cheapest setting within a tolerance; figure
// of the numerical error against cost, and of the error of a campaign's mean against its cost. Moments of a campaign
// with an error goal.
#pragma once

#include "sweep/plot/plot.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/study.hpp"
#include "sweep/study/accuracy.hpp"
#include "sweep/study/corrected.hpp"

#include <span>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// Returns the document. `observables`: the judged ones, shown in the text; empty: all. Rows and JSON always have all.
[[nodiscard]] Document accuracy_document(std::string_view campaign, std::span<const study::NumericsCost> costs,
                                         std::span<const std::string> observables, double tolerance);

/// Returns two panels for each observable.
///
/// 1. Bias of each setting against the processor time of a case, with 95 % whiskers and dashed lines at the tolerance.
/// 2. Error of the mean that a campaign of N random points at one setting has at 95 %, against its processor time N c,
///    with bias b, cost c of a case and standard deviation s of its answers: sqrt(b^2 + 1.96^2 s^2/N).
///
/// All errors are relative to the mean at the most accurate setting; an observable whose mean is 0 has no panel.
[[nodiscard]] plot::Figure accuracy_figure(std::span<const study::NumericsCost> costs,
                                           std::span<const std::string> observables, double tolerance);

/// Returns one row per statistic of a campaign with an error goal: value at the chosen setting, corrected value, and
/// the parts of the relative error.
[[nodiscard]] store::Table corrected_table(const study::Corrected& corrected);
[[nodiscard]] Result<results::corrected> corrected_json(const study::Corrected& corrected);

}  // namespace grainsweep::report
