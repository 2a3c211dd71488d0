// A process window as a page of its own, to be printed and to hang beside the machine: the best setting, what it gives
// with its errors, the map of the two factors that decide the condition, and every response against every factor. Map
// and curves go through the best setting (where there is none, the one where the condition is likeliest). A factor
// decides by the variance of the probability that its value makes over the searched box; where factors decide alike, by
// how much it changes along its curve: range of the probability, and range of the objective's mean divided by that of
// its means at the cases.
// Curves have 41 points, the map 41 x 41 cells, evenly over the ranges (logarithmic ones over their logarithms); a
// factor with levels has one each. Bands are 95 %: of the mean, and of a single run about it.
#pragma once

#include "sweep/report/table.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/process_window.hpp"

#include <iosfwd>
#include <string_view>

namespace grainsweep::report {

/// As the page's program reads it: {"campaign", "where", "objective", "risk", "share", "factors", "best", "meets",
/// "failed": settings and outcomes of failed cases, "failed_near", "order": factors by how much they matter, "curves":
/// one per factor, "map": of the first two of `order` or null, "front", "next", "models", "notes"}. `admits`: settings
/// that the campaign's `where` leaves out are drawn as empty.
[[nodiscard]] Json window_page_data(const study::ModelCases& cases, const study::WindowRequest& request,
                                    const study::Window& window, const study::Admits& admits);

/// Asks nothing of any network. `database`: what the page calls it.
void write_window_page(std::ostream& out, const Json& data, std::string_view database);

}  // namespace grainsweep::report
