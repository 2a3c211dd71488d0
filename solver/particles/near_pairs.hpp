// All pairs of points closer than a range, each once, by cells: for measuring a state, not for stepping one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Points sorted into cubic cells at least `range` wide that cover their bounding box, x fastest.
class CellGrid {
public:
    /// range > 0; the positions must outlive the grid and stay where they are.
    CellGrid(std::span<const std::array<double, 3>> positions, double range);

    /// Calls visit(i, j, distance) once for every pair with distance < range; i and j index the positions.
    /// The order depends on the positions only.
    template <class Visit>
    void for_each_pair(Visit&& visit) const;

    /// Calls visit(i, distance) for every position with distance < range from a point anywhere.
    template <class Visit>
    void for_each_near(const std::array<double, 3>& point, Visit&& visit) const;

private:
    using Cell = std::array<std::int64_t, 3>;

    [[nodiscard]] Cell cell_of(const std::array<double, 3>& point) const;
    [[nodiscard]] std::size_t number(const Cell& c) const {
        return static_cast<std::size_t>((c[2] * cells_[1] + c[1]) * cells_[0] + c[0]);
    }
    /// Members of the cells first.x ... last.x of a row, as one range of `order_`.
    [[nodiscard]] std::span<const std::uint32_t> row(std::int64_t first_x, std::int64_t last_x, std::int64_t y,
                                                     std::int64_t z) const;
    [[nodiscard]] double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) const {
        const double dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
        return std::sqrt(dx * dx + dy * dy + dz * dz);
    }

    std::span<const std::array<double, 3>> positions_;
    double range_;
    std::array<double, 3> low_{};
    Cell cells_{1, 1, 1};
    double width_;
    std::vector<std::uint32_t> order_, first_;
};

template <class Visit>
void CellGrid::for_each_pair(Visit&& visit) const {
    for (std::size_t i = 0; i < positions_.size(); ++i)
        for_each_near(positions_[i], [&](std::size_t j, double r) {
            if (j > i) visit(i, j, r);
        });
}

template <class Visit>
void CellGrid::for_each_near(const std::array<double, 3>& point, Visit&& visit) const {
    const Cell c = cell_of(point);
    for (std::int64_t z = c[2] - 1; z <= c[2] + 1; ++z)
        for (std::int64_t y = c[1] - 1; y <= c[1] + 1; ++y)
            for (const std::uint32_t i : row(c[0] - 1, c[0] + 1, y, z)) {
                const double r = distance(point, positions_[i]);
                if (r < range_) visit(static_cast<std::size_t>(i), r);
            }
}

}  // namespace grainsweep::particles
