#include "solver/geometry/triangle_grid.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::geometry {
namespace {

/// Twice the mean distance between the middles of triangles, were they spread over their area evenly: a few triangles
/// in a cell of a fine surface. At most `most` cells all together, however thin the box is.
double cell_edge(std::span<const Triangle> triangles, const Vec3& extent, double most) {
    double area = 0;
    for (const Triangle& t : triangles) area += norm(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0])) / 2;
    double edge = 2 * std::sqrt(area / static_cast<double>(triangles.size()));
    const auto cells = [&](double h) {
        return std::ceil(extent[0] / h + 1) * std::ceil(extent[1] / h + 1) * std::ceil(extent[2] / h + 1);
    };
    while (cells(edge) > most) edge *= 1.25;
    return edge;
}

}  // namespace

TriangleGrid::TriangleGrid(std::span<const Triangle> triangles) {
    if (triangles.empty()) return;
    low_ = high_ = triangles.front().corner[0];
    for (const Triangle& t : triangles)
        for (const Vec3& x : t.corner)
            for (std::size_t k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], x[k]);
                high_[k] = std::max(high_[k], x[k]);
            }
    const Vec3 extent = high_ - low_;
    edge_ = cell_edge(triangles, extent, 4096 + 8 * static_cast<double>(triangles.size()));
    for (std::size_t k = 0; k < 3; ++k) cells_[k] = static_cast<std::size_t>(std::floor(extent[k] / edge_)) + 1;

    // A triangle reaches into a cell at most where it comes near its middle; rounding is far below the 1 % beyond.
    const double half_diagonal = 1.01 * std::sqrt(0.75) * edge_;
    const auto for_each_entry = [&](auto&& visit) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto& c = triangles[t].corner;
            Vec3 low = c[0], high = c[0];
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t n = 1; n < 3; ++n) {
                    low[k] = std::min(low[k], c[n][k]);
                    high[k] = std::max(high[k], c[n][k]);
                }
            for_each_cell(range(low, high), [&](const std::array<std::size_t, 3>& place, std::size_t cell) {
                Vec3 middle = low_;
                for (std::size_t k = 0; k < 3; ++k) middle[k] += (static_cast<double>(place[k]) + 0.5) * edge_;
                if (triangles[t].nearest(middle).distance <= half_diagonal) visit(t, cell);
            });
        }
    };
    begin_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
    for_each_entry([&](std::uint32_t, std::size_t cell) { ++begin_[cell + 1]; });
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    entries_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for_each_entry([&](std::uint32_t t, std::size_t cell) { entries_[next[cell]++] = t; });
}

std::size_t TriangleGrid::cell_along(std::size_t axis, double x) const {
    const double last = static_cast<double>(cells_[axis] - 1);
    return static_cast<std::size_t>(std::clamp(std::floor((x - low_[axis]) / edge_), 0.0, last));
}

std::array<TriangleGrid::Range, 3> TriangleGrid::range(const Vec3& low, const Vec3& high) const {
    std::array<Range, 3> box{};
    for (std::size_t k = 0; k < 3; ++k) box[k] = {cell_along(k, low[k]), cell_along(k, high[k])};
    return box;
}

template <class Visit>
void TriangleGrid::for_each_cell(const std::array<Range, 3>& box, Visit&& visit) const {
    for (std::size_t k = box[2][0]; k <= box[2][1]; ++k)
        for (std::size_t j = box[1][0]; j <= box[1][1]; ++j)
            for (std::size_t i = box[0][0]; i <= box[0][1]; ++i)
                visit(std::array<std::size_t, 3>{i, j, k}, i + cells_[0] * (j + cells_[1] * k));
}

void TriangleGrid::in_box(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& into) const {
    into.clear();
    if (entries_.empty()) return;
    for (std::size_t k = 0; k < 3; ++k)
        if (!(low[k] <= high_[k] && high[k] >= low_[k])) return;
    for_each_cell(range(low, high), [&](const std::array<std::size_t, 3>&, std::size_t cell) {
        into.insert(into.end(), entries_.begin() + begin_[cell], entries_.begin() + begin_[cell + 1]);
    });
    std::ranges::sort(into);
    into.erase(std::unique(into.begin(), into.end()), into.end());
}

}  // namespace grainsweep::geometry
