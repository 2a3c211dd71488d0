#include "solver/geometry/tpms_outlet.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grainsweep::geometry {

double outlet_diameter(const TpmsShell& shell) {
    constexpr std::size_t side = 256;
    const double pitch = shell.edge() / side;
    const auto at = [](std::size_t row, std::size_t column) { return row * side + column; };
    const auto coordinate = [pitch](std::size_t k) { return (static_cast<double>(k) + 0.5) * pitch; };

    // Steps along its row to the nearest point that is not kept; more than any distance where there is none.
    std::vector<std::size_t> steps(side * side, 4 * side);
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t column = 0; column < side; ++column) {
            const bool kept = shell.classify({coordinate(column), coordinate(row), 0}) == TpmsRegion::kept;
            steps[at(row, column)] = kept ? (column > 0 ? steps[at(row, column - 1)] + 1 : 4 * side) : 0;
        }
        for (std::size_t column = side - 1; column-- > 0;)
            steps[at(row, column)] = std::min(steps[at(row, column)], steps[at(row, column + 1)] + 1);
    }
    // Then over all rows: squared distance = steps along that row squared + rows between squared.
    std::size_t largest = 0;
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < side; ++column) {
            std::size_t nearest = steps[at(row, column)] * steps[at(row, column)];
            for (std::size_t other = 0; other < side && nearest > largest; ++other) {
                const std::size_t along = steps[at(other, column)], across = other > row ? other - row : row - other;
                nearest = std::min(nearest, along * along + across * across);
            }
            largest = std::max(largest, nearest);
        }
    return std::min(shell.edge(), 2 * pitch * std::sqrt(static_cast<double>(largest)));
}

}  // namespace grainsweep::geometry
