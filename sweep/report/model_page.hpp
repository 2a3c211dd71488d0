// Figures of a response model: the response against every factor with its bands, and a map of the two most influential
// factors. The other factors are averaged over their ranges, or at the middle.
//
//   averaged   mean of the mean response at 128 Sobol points of the other factors. Points that the campaign's `where`
//              excludes, and points where an answer is less likely than a failure (answers.hpp), do not count. If less
//              than four are left, nothing is drawn
//   slice      the other factors at the middle of their ranges (levels: the middle one), with the 95 % bands of the
//              mean and of a single run
//
// Curves have 31 points, the map 21 x 21 cells, evenly along the ranges (logarithmic ranges in their logarithms). The
// influence of a factor is the range of its averaged curve.
#pragma once

#include "sweep/study/response_models.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace grainsweep::report {

/// Curve against one factor; NaN: not drawn.
struct ModelCurve {
    std::vector<double> at, averaged, mean, mean_half_width, run_half_width;

    /// Adds the mean and the half-widths of a point; not drawn unless `shown`.
    void add(const stats::Prediction& point, bool shown);
    /// Returns the largest minus the smallest value of `averaged`.
    [[nodiscard]] double range() const;
};
/// Two factors of a map. Its numbers are row by row along `up`.
struct MapPlace {
    std::size_t across = 0, up = 0;
    std::size_t count = 0;  ///< cells along a range
};
struct ModelMap : MapPlace {
    std::vector<double> averaged, slice;
};
struct ModelPictures {
    study::Setting middle;
    std::vector<ModelCurve> curves;  ///< one per factor
    std::vector<std::size_t> order;  ///< factors by their influence
    std::optional<ModelMap> map;     ///< of the first two; empty: there is only one factor
};
/// Computes the figures. Settings that `admits` excludes are empty.
[[nodiscard]] ModelPictures model_pictures(const study::ModelCases& cases, const study::ObservableModel& model,
                                           const std::function<bool(const study::Setting&)>& admits);

/// Cases of a response model, and its figures.
struct Modelled {
    study::ModelCases cases;
    ModelPictures pictures;
};

}  // namespace grainsweep::report
