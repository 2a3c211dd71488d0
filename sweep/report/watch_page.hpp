// A case to watch: one page with its film and the player, which asks nothing of any network.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/report/film.hpp"

#include <string>
#include <string_view>

namespace grainsweep::report {

/// What a page says of a case beside its film: title, inputs and results with their units, and why it ended where it
/// is not completed.
[[nodiscard]] Json about_case(const campaign::Case& question, const campaign::CaseResult& result);

/// The page. Throws std::invalid_argument where the film shows nothing.
[[nodiscard]] std::string watch_page(const Film& film, const Json& about);

/// What another page needs to show films: a style sheet, and a program that defines grainsweepWatch.
struct Player {
    std::string_view style;
    std::string_view program;
    std::string_view in_report;  ///< what plays films behind the report's `grainsweep:case` events
};
[[nodiscard]] Player player();

}  // namespace grainsweep::report
