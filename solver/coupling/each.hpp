// Loops that the threads of a case share.
#pragma once

#include "solver/flow/field.hpp"
#include "solver/threads/slabs.hpp"

#include <cstddef>

namespace grainsweep::coupling {

/// Calls body(m) for 0 ... count - 1.
template <class Body>
void each_of(std::size_t count, const Slabs& slabs, const Body& body) {
    slabs.over(0, static_cast<std::ptrdiff_t>(count) - 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto m = static_cast<std::size_t>(first); m <= static_cast<std::size_t>(last); ++m) body(m);
    });
}

/// Calls body(i, j, k) for every cell of the box.
template <class Body>
void each_cell(const flow::Grid& grid, const Slabs& slabs, const Body& body) {
    slabs.over(1, grid.cells(2), [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (int k = static_cast<int>(first); k <= static_cast<int>(last); ++k)
            for (int j = 1; j <= grid.cells(1); ++j)
                for (int i = 1; i <= grid.cells(0); ++i) body(i, j, k);
    });
}

}  // namespace grainsweep::coupling
