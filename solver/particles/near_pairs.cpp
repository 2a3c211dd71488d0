#include "solver/particles/near_pairs.hpp"

namespace grainsweep::particles {

CellGrid::CellGrid(std::span<const std::array<double, 3>> positions, double range)
    : positions_(positions), range_(range), width_(range) {
    if (positions.empty()) return;
    low_ = positions.front();
    std::array<double, 3> high = low_;
    for (const auto& x : positions)
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] = std::min(low_[k], x[k]);
            high[k] = std::max(high[k], x[k]);
        }
    // Far outliers must not make the grid larger than the points deserve.
    const auto enough = 8 * static_cast<double>(positions.size()) + 64;
    const auto count = [&](std::size_t k) { return std::floor((high[k] - low_[k]) / width_) + 1; };
    while (count(0) * count(1) * count(2) > enough) width_ *= 2;
    for (std::size_t k = 0; k < 3; ++k) cells_[k] = static_cast<std::int64_t>(count(k));

    first_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
    for (const auto& x : positions) ++first_[number(cell_of(x)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    order_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        order_[next[number(cell_of(positions[i]))]++] = static_cast<std::uint32_t>(i);
}

CellGrid::Cell CellGrid::cell_of(const std::array<double, 3>& point) const {
    Cell c{};
    for (std::size_t k = 0; k < 3; ++k) {
        // Points outside the box count as one cell beyond it, where a neighbour may still be in range.
        const double place = std::floor((point[k] - low_[k]) / width_);
        c[k] = static_cast<std::int64_t>(std::clamp(place, -2.0, static_cast<double>(cells_[k]) + 1));
    }
    return c;
}

std::span<const std::uint32_t> CellGrid::row(std::int64_t first_x, std::int64_t last_x, std::int64_t y,
                                             std::int64_t z) const {
    if (positions_.empty() || y < 0 || y >= cells_[1] || z < 0 || z >= cells_[2]) return {};
    first_x = std::max<std::int64_t>(first_x, 0);
    last_x = std::min(last_x, cells_[0] - 1);
    if (first_x > last_x) return {};
    const std::size_t begin = first_[number({first_x, y, z})], end = first_[number({last_x, y, z}) + 1];
    return std::span(order_).subspan(begin, end - begin);
}

}  // namespace grainsweep::particles
