// Places along a factor at which pictures evaluate a response model. The points of a curve include the ends of the
// range; a map uses the middles of its cells. Logarithmic ranges are divided evenly in the logarithm. Each level has
// one place.
#pragma once

#include "sweep/study/features.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::study {

/// Returns numbers of a factor along its range.
[[nodiscard]] std::vector<double> points_along(const ModelFactor& factor, std::size_t count);
[[nodiscard]] std::vector<double> cells_along(const ModelFactor& factor, std::size_t count);
/// Returns the edges of the cells, one more than cells; empty for levels.
[[nodiscard]] std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count);

/// Returns the settings of a map of factors a and b, with the other factors as in `centre`; a varies fastest.
[[nodiscard]] std::vector<Setting> settings_of_map(std::span<const ModelFactor> factors, const Setting& centre,
                                                   std::size_t a, std::size_t b, std::size_t count);

}  // namespace grainsweep::study
