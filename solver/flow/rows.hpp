// What the equations of the flow share: the rows of unknowns of a field and the weights of the step.
#pragma once

#include "solver/flow/field.hpp"

#include <array>
#include <cstddef>

namespace grainsweep::flow {

[[nodiscard]] inline std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

/// Calls body(start of the row, j, k) with i = 0 for every row of unknowns.
template <class Body>
void each_row(const Field& shape, const std::array<int, 3>& first, const std::array<int, 3>& cells, Body body) {
    for (int k = first[2]; k <= cells[2]; ++k)
        for (int j = first[1]; j <= cells[1]; ++j) body(shape.index(0, j, k), j, k);
}

[[nodiscard]] inline std::array<int, 3> cell_counts(const Grid& grid) {
    return {grid.cells(0), grid.cells(1), grid.cells(2)};
}

/// Of C^n and C^{n-1}.
struct StepWeights {
    double now, before;
};
/// Adams-Bashforth of second order; the first step has no past and takes Euler.
[[nodiscard]] inline StepWeights convection_weights(bool first) {
    return first ? StepWeights{1.0, 0.0} : StepWeights{1.5, -0.5};
}

}  // namespace grainsweep::flow
