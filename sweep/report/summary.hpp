// What a run ends with: counts by outcome, moments with errors, extremes, where everything is.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace grainsweep::report {

/// The provisional figures in one line, marked so; empty where there are none.
[[nodiscard]] std::string provisional_line(const study::History& history);

/// "640 completed, 12 unstable": outcomes that occur.
[[nodiscard]] std::string outcome_line(const study::Responses& responses);

/// "heap: angle (1) over 64 points of a sobol design; 64 completed"
[[nodiscard]] std::string study_heading(const study::Responses& responses, const study::ResponseColumn& response);

/// One row per scalar observable, the main one first: moments with their 95 % errors over the settled beginning; while
/// finished cases lie behind one that is not, the provisional ones over all of them.
[[nodiscard]] store::Table moments_table(const study::Responses& responses);

/// The rows with the `count` largest and the `count` smallest values of a response: point, factors, value. Where there
/// are no more than twice as many, all of them.
[[nodiscard]] store::Table extremes_table(const study::Responses& responses, const study::ResponseColumn& response,
                                          std::size_t count);

/// The text `run` ends with. `campaign` must be in the store.
[[nodiscard]] Document closing_summary(const store::Store& store, const std::string& campaign,
                                       const std::filesystem::path& database);

}  // namespace grainsweep::report
