// A response model in pictures: the response against every factor with its bands, and over the two factors that matter
// most, the other factors averaged over their ranges or at the middle.
//
//   averaged   mean over 128 Sobol points of the other factors of the mean response; points that the campaign's `where`
//              leaves out and points where an answer is less likely than none (answers.hpp) do not count, where less
//              than four are left there is nothing
//   slice      the other factors at the middle of their ranges (levels: the middle one), with the 95 % bands of
//              the mean and of a single run about it
//
// Curves have 31 points, the map 21 x 21 cells, evenly over the ranges (logarithmic ones over their logarithms). A
// factor matters by the range of its averaged curve.
#pragma once

#include "sweep/report/table.hpp"
#include "sweep/study/response_models.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace grainsweep::report {

/// Against one factor; NaN where nothing is drawn.
struct ModelCurve {
    std::vector<double> at, averaged, mean, mean_half_width, run_half_width;

    /// Of `averaged`: largest less smallest.
    [[nodiscard]] double range() const;
};
/// Over two factors, row by row along `up`.
struct ModelMap {
    std::size_t across = 0, up = 0;
    std::size_t count = 0;  ///< cells along a range
    std::vector<double> averaged, slice;
};
struct ModelPictures {
    study::Setting middle;
    std::vector<ModelCurve> curves;  ///< one per factor
    std::vector<std::size_t> order;  ///< factors by how much they matter
    std::optional<ModelMap> map;     ///< of the first two; none: there is one factor
};
/// `admits`: settings that are left out are empty.
[[nodiscard]] ModelPictures model_pictures(const study::ModelCases& cases, const study::ObservableModel& model,
                                           const std::function<bool(const study::Setting&)>& admits);

/// {"observable", "unit", "says": lines, "factors", "order": factors by how much they matter, "middle": {"setting",
/// "texts"}, "failed": settings and outcomes of failed cases, "curves": one per factor {"at", "averaged", "mean",
/// "mean_half_width", "run_half_width"}, "map": of the first two of `order` or null {"across", "up", "across_edges",
/// "up_edges", "columns", "rows", "averaged", "slice"}}. `admits`: settings that are left out are empty.
[[nodiscard]] Json model_page_data(const study::ModelCases& cases, const study::ObservableModel& model,
                                   const std::function<bool(const study::Setting&)>& admits);

}  // namespace grainsweep::report
