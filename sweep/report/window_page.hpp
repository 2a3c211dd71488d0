// Page of a process window, for print: the best setting, its predictions with errors, a map of the two most influential
// factors, and every response against every factor. Map and curves pass through the best setting, or, if there is none,
// through the setting with the largest probability. The influence of a factor is the variance of the probability due to
// its value in the searched box. Factors of equal influence are ordered by the change along their curves: the range of
// the probability, and the range of the objective's mean relative to the range of its means at the cases.
// Curves have 41 points, the map 41 x 41 cells, evenly along the ranges (logarithmic ranges in their logarithms), or
// one per level. Bands are 95 % bands of the mean and of a single run.
#pragma once

#include "sweep/report/model_page.hpp"
#include "sweep/report/table.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/process_window.hpp"

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// Predictions along a factor, through the setting.
struct WindowCurve {
    std::vector<double> at;
    std::vector<study::Judgement> judged;
    std::vector<ModelCurve> responses;  ///< one per model; NaN: not drawn
};
/// Map of the first two factors. NaN: an empty cell.
struct WindowMap : MapPlace {
    std::vector<double> probability, objective;  ///< no objective: no model of one
};
struct WindowPictures {
    std::vector<std::size_t> order;   ///< factors by their influence
    std::vector<WindowCurve> curves;  ///< one per factor
    std::optional<WindowMap> map;     ///< empty: there is only one factor
};
/// Computes the figures. Settings that the campaign's `where` excludes (`admits`) are empty.
[[nodiscard]] WindowPictures window_pictures(const study::ModelCases& cases, const study::WindowRequest& request,
                                             const study::Window& window, const study::Admits& admits);

/// Returns the texts, tables and drawn figures for the script of the page.
[[nodiscard]] Json window_page_data(const study::ModelCases& cases, const study::WindowRequest& request,
                                    const study::Window& window, const study::Admits& admits);

/// Writes the page, which needs no network. `database`: its name on the page.
void write_window_page(std::ostream& out, const Json& data, std::string_view database);

}  // namespace grainsweep::report
