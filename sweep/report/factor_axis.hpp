// Where along a factor a response model is asked for pictures: curves at points that include the ends of the range,
// maps at the middles of cells; logarithmic ranges evenly over their logarithms, a factor with levels once for each.
#pragma once

#include "sweep/report/features.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::report {

/// Numbers of a factor along its range.
[[nodiscard]] std::vector<double> points_along(const ModelFactor& factor, std::size_t count);
[[nodiscard]] std::vector<double> cells_along(const ModelFactor& factor, std::size_t count);
/// Where the cells begin and end, one more than there are; of levels none.
[[nodiscard]] std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count);

/// As a page's program reads them: [{"name", "unit", "levels": texts, "numbers", "low", "high", "log"}, ...]
[[nodiscard]] nlohmann::ordered_json axes_json(std::span<const ModelFactor> factors);

}  // namespace grainsweep::report
