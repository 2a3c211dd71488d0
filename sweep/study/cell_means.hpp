// Mean response over two factors, cell by cell. A level, and each of up to 12 distinct values, is a cell of its own.
// Otherwise sqrt(n/8) cells, 3 to 14, divide the range evenly (logarithmic ones in their logarithms).
#pragma once

#include "sweep/study/responses.hpp"

#include <vector>

namespace grainsweep::study {

struct CellMeans {
    std::vector<double> x_edges, y_edges;  ///< of levels -0.5, 0.5, ...
    std::vector<double> means;             ///< row by row along y; NaN: no case
};

/// Over the rows with a value of all three.
[[nodiscard]] CellMeans cell_means(const FactorColumn& across, const FactorColumn& up, const ResponseColumn& response);

}  // namespace grainsweep::study
