// What designs that follow their answers have found: the brackets of a refine campaign, the posterior of a calibration.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/brackets.hpp"
#include "sweep/study/calibration.hpp"
#include "sweep/study/responses.hpp"

#include <optional>
#include <string>

namespace grainsweep::report {

/// None for a campaign of another design.
[[nodiscard]] std::optional<Document> findings_document(const store::Store& store, const study::Responses& responses);

/// "retention passes 0.5 along cohesion: 5 of 6 brackets are 1000 J/m3 wide or less, 1 is above throughout".
[[nodiscard]] std::string brackets_line(const study::Brackets& brackets);
/// For people: one row per combination.
[[nodiscard]] store::Table brackets_table(const study::Brackets& brackets);

/// Where it stands, waves, posterior and targets, for people.
void say_calibration(Document& shown, const study::CalibrationReport& report);
/// For the page: factors with their ranges, draws of the posterior and the settings run, in the factors' units.
[[nodiscard]] Json page_of(const study::CalibrationReport& report);

}  // namespace grainsweep::report
