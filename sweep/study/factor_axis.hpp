// Places along a factor at which pictures evaluate a response model. Curves have points that include the ends of the
// range, maps the middles of cells. Logarithmic ranges are even in their logarithms; levels have one place each.
#pragma once

#include "sweep/study/features.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::study {

/// Numbers of a factor along its range.
[[nodiscard]] std::vector<double> points_along(const ModelFactor& factor, std::size_t count);
[[nodiscard]] std::vector<double> cells_along(const ModelFactor& factor, std::size_t count);
/// Where the cells begin and end, one more than there are; of levels none.
[[nodiscard]] std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count);

/// Settings of a map over factors a and b, the others as in `centre`; a goes fastest.
[[nodiscard]] std::vector<Setting> settings_of_map(std::span<const ModelFactor> factors, const Setting& centre,
                                                   std::size_t a, std::size_t b, std::size_t count);

}  // namespace grainsweep::study
