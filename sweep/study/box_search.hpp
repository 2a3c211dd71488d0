// Settings in a campaign's box, spread over the whole box or around one setting. For a factor with a distribution the
// box is the range of ModelFactor, and the settings follow the distribution, so that a share of settings is a
// probability.
#pragma once

#include "sweep/designs/design.hpp"
#include "sweep/study/features.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::study {

/// Returns a design of the kind "sobol"; options that are not given have their default values.
[[nodiscard]] designs::PointSet sobol_points(designs::DesignRequest request);

/// Setting and its point in the unit cube.
struct BoxPoint {
    std::vector<double> u;
    Setting setting;
};

/// Filter of settings; empty: all are admitted.
using Admits = std::function<bool(const Setting&)>;

/// Returns those of `count` Sobol points of the box that are admitted.
[[nodiscard]] std::vector<BoxPoint> spread_points(std::span<const ModelFactor> factors, const Admits& admits,
                                                  std::size_t count);
/// Returns Sobol points of the box of half-width `reach` (a fraction of the ranges) around a point, cut at the bounds.
/// Factors with levels keep their level.
[[nodiscard]] std::vector<BoxPoint> points_about(const BoxPoint& centre, double reach,
                                                 std::span<const ModelFactor> factors, const Admits& admits,
                                                 std::size_t count);

/// Returns the words for the whole that a share of settings refers to: "the box", or the distribution of the factors.
[[nodiscard]] std::string_view share_of(std::span<const ModelFactor> factors);
/// Returns the factor over its range alone, for a factor with a distribution: evenly, or in the logarithm.
[[nodiscard]] campaign::Factor along_axis(const ModelFactor& factor);
/// Returns the number of a factor at the fraction u of its range; for levels, the level at this fraction of their list.
[[nodiscard]] double number_along(const ModelFactor& factor, double u);
/// Returns the setting at a point of the unit cube, by the distributions of the factors where they have some. Values
/// are rounded to a thousandth of the range's order of magnitude (of the value's order if the range is logarithmic),
/// within the range. Shares add to one; all but the last are rounded to a thousandth. A factor that does not count has
/// its default.
[[nodiscard]] Setting rounded_setting(std::span<const ModelFactor> factors, std::span<const double> u);
/// Returns the same without rounding, as in a design.
[[nodiscard]] Setting exact_setting(std::span<const ModelFactor> factors, std::span<const double> u);

// Places along a factor at which pictures evaluate a response model. The points of a curve include the ends of the
// range; a map uses the middles of its cells. Logarithmic ranges are divided evenly in the logarithm. Each level has
// one place.

/// Returns numbers of a factor along its range.
[[nodiscard]] std::vector<double> points_along(const ModelFactor& factor, std::size_t count);
[[nodiscard]] std::vector<double> cells_along(const ModelFactor& factor, std::size_t count);
/// Returns the edges of the cells, one more than cells; empty for levels.
[[nodiscard]] std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count);

/// Returns the settings of a map of factors a and b, with the other factors as in `centre`; a varies fastest.
[[nodiscard]] std::vector<Setting> settings_of_map(std::span<const ModelFactor> factors, const Setting& centre,
                                                   std::size_t a, std::size_t b, std::size_t count);

}  // namespace grainsweep::study
