// Summary at the end of a run: counts by outcome, moments with errors, extremes, and output files.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace grainsweep::report {

/// Returns the provisional moments in one line, marked as such; empty if there are none.
[[nodiscard]] std::string provisional_line(const study::History& history);

/// Returns the counts of outcomes, such as "640 completed, 12 unstable".
[[nodiscard]] std::string outcome_line(const study::Responses& responses);

/// Returns a heading such as "heap: angle (1) over 64 points of a sobol design; 64 completed".
[[nodiscard]] std::string study_heading(const study::Responses& responses, const study::ResponseColumn& response);

/// Returns one row per scalar observable, the main one first: moments with 95 % errors from the settled prefix. If
/// there are finished cases behind an unfinished one, provisional moments of all finished cases.
[[nodiscard]] store::Table moments_table(const study::Responses& responses);

/// Returns the rows with the `count` largest and the `count` smallest values of a response: point, factors, value. All
/// rows if there are at most 2 `count`.
[[nodiscard]] store::Table extremes_table(const study::Responses& responses, const study::ResponseColumn& response,
                                          std::size_t count);

/// Returns the last text of `run`: mean and standard deviation of the main observables, or with `all` every moment of
/// every observable. `campaign` must be in the store.
[[nodiscard]] Document closing_summary(const store::Store& store, const std::string& campaign,
                                       const std::filesystem::path& database, bool all);

}  // namespace grainsweep::report
