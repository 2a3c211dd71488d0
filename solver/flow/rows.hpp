// Loops over the rows of unknowns of a field, and the weights of the step.
#pragma once

#include "solver/flow/field.hpp"
#include "solver/threads/slabs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainsweep::flow {

[[nodiscard]] inline std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

/// Calls body(start of the row, j, k) with i = 0 for every row of unknowns in these planes.
template <class Body>
void each_row(const Field& shape, const std::array<int, 3>& first, const std::array<int, 3>& cells,
              const Planes& planes, Body body) {
    for (int k = std::max(first[2], planes.first); k <= std::min(cells[2], planes.last); ++k)
        for (int j = first[1]; j <= cells[1]; ++j) body(shape.index(0, j, k), j, k);
}

/// Calls body(planes) for slabs of all planes of a field, ghosts included.
template <class Body>
void each_slab(const Slabs& slabs, const std::array<int, 3>& cells, Body body) {
    slabs.over(0, cells[2] + 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        body(Planes{static_cast<int>(first), static_cast<int>(last)});
    });
}

/// Sets to[m] = value(m) for all values of these planes of a field.
template <class Value>
void set_planes(Field& to, const Planes& planes, Value value) {
    double* const values = to.data();
    const auto end = to.index(0, 0, planes.last + 1);
    for (auto m = to.index(0, 0, planes.first); m < end; ++m) values[m] = value(m);
}

[[nodiscard]] inline std::array<int, 3> cell_counts(const Grid& grid) {
    return {grid.cells(0), grid.cells(1), grid.cells(2)};
}

/// Returns the start of row (j, k) in values without ghosts.
[[nodiscard]] inline std::ptrdiff_t compact_row(const std::array<int, 3>& cells, int j, int k) {
    return (static_cast<std::ptrdiff_t>(k - 1) * cells[1] + (j - 1)) * cells[0];
}

/// Weights of C^n and C^{n-1}.
struct StepWeights {
    double now, before;
};
/// Returns the weights of second-order Adams-Bashforth, or of Euler in the first step.
[[nodiscard]] inline StepWeights convection_weights(bool first) {
    return first ? StepWeights{1.0, 0.0} : StepWeights{1.5, -0.5};
}

}  // namespace grainsweep::flow
