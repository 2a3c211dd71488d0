// Settings of a campaign's box: spread over all of it, or about one of them. Of a factor with a distribution the box is
// the range of ModelFactor, and settings are spread as the distribution is: a share of them is a probability.
#pragma once

#include "sweep/designs/design.hpp"
#include "sweep/study/features.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::study {

/// A design of the catalogue's kind "sobol"; options that are not given have their default values.
[[nodiscard]] designs::PointSet sobol_points(designs::DesignRequest request);

/// A setting and where it stands in the unit cube.
struct BoxPoint {
    std::vector<double> u;
    Setting setting;
};

/// Empty: every setting passes.
using Admits = std::function<bool(const Setting&)>;

/// `count` Sobol points of the box, without the points that are not admitted.
[[nodiscard]] std::vector<BoxPoint> spread_points(std::span<const ModelFactor> factors, const Admits& admits,
                                                  std::size_t count);
/// Sobol points of the box of half-width `reach` (in ranges) about a point, cut at the walls; factors with levels stay.
[[nodiscard]] std::vector<BoxPoint> points_about(const BoxPoint& centre, double reach,
                                                 std::span<const ModelFactor> factors, const Admits& admits,
                                                 std::size_t count);

/// What a share of the settings is a share of: "the box", or the distribution of the factors.
[[nodiscard]] std::string_view share_of(std::span<const ModelFactor> factors);
/// The number of a factor at share u of its range; of levels one by its place among them.
[[nodiscard]] double number_along(const ModelFactor& factor, double u);
/// Returns the setting at a point of the unit cube, by the distributions of the factors where they have some. Values
/// are rounded to a thousandth of the range's order of magnitude (of the value's, where the range is logarithmic),
/// within the range. Shares add to one, all but the last rounded to a thousandth. A factor that does not
/// count has its default.
[[nodiscard]] Setting rounded_setting(std::span<const ModelFactor> factors, std::span<const double> u);
/// The same without rounding, as in a design.
[[nodiscard]] Setting exact_setting(std::span<const ModelFactor> factors, std::span<const double> u);

}  // namespace grainsweep::study
