// Mean response in cells of two factors. Each level, and each of up to 12 distinct values, is a cell of its own.
// Otherwise sqrt(n/8) cells, 3 to 14, divide the range evenly, a logarithmic range in its logarithm.
#pragma once

#include "sweep/study/responses.hpp"

#include <vector>

namespace grainsweep::study {

struct CellMeans {
    std::vector<double> x_edges, y_edges;  ///< for levels -0.5, 0.5, ...
    std::vector<double> means;             ///< row by row along y; NaN: cell without a case
};

/// Returns the means over the rows that have values of both factors and of the response.
[[nodiscard]] CellMeans cell_means(const FactorColumn& across, const FactorColumn& up, const ResponseColumn& response);

}  // namespace grainsweep::study
