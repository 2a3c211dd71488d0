// Results of growing designs: the brackets of a refine campaign, the posterior of a calibration.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/brackets.hpp"
#include "sweep/study/calibration.hpp"
#include "sweep/study/responses.hpp"

#include <optional>
#include <string>

namespace grainsweep::report {

/// Returns the results; empty for a campaign of another design.
[[nodiscard]] std::optional<Document> findings_document(const store::Store& store, const study::Responses& responses);

/// Returns a line such as "retention passes 0.5 along cohesion: 5 of 6 brackets are 1000 J/m3 wide or less, 1 is above
/// throughout".
[[nodiscard]] std::string brackets_line(const study::Brackets& brackets);
/// Returns a table for people: one row per combination.
[[nodiscard]] store::Table brackets_table(const study::Brackets& brackets);

/// Appends state, waves, posterior and targets of a calibration for people.
void say_calibration(Document& shown, const study::CalibrationReport& report);
/// Returns the data for the page: tables, and factors with their ranges.
[[nodiscard]] Json page_of(const study::CalibrationReport& report);

}  // namespace grainsweep::report
