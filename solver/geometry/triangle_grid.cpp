#include "solver/geometry/triangle_grid.hpp"

#include "solver/geometry/bounds.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::geometry {
namespace {

/// Twice the mean distance between the middles of evenly spread triangles, so that a cell of a fine surface has a few
/// triangles.
double natural_edge(std::span<const Triangle> triangles) {
    double area = 0;
    for (const Triangle& t : triangles) area += norm(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0])) / 2;
    return 2 * std::sqrt(area / static_cast<double>(triangles.size()));
}

/// Cells that the boxes around triangles reach into, all together.
double visited(std::span<const Triangle> triangles, double margin, double edge) {
    double sum = 0;
    for (const Triangle& t : triangles) {
        const Bounds box = bounds_around(t.corner);
        double cells = 1;
        for (std::size_t k = 0; k < 3; ++k) cells *= (box.high[k] - box.low[k] + 2 * margin) / edge + 2;
        sum += cells;
    }
    return sum;
}

}  // namespace

TriangleGrid::TriangleGrid(std::span<const Triangle> triangles) {
    if (triangles.empty()) return;
    choose_cells(triangles, natural_edge(triangles));
    fill(triangles);
}

TriangleGrid::TriangleGrid(std::span<const Triangle> triangles, double margin) : margin_(margin) {
    if (triangles.empty()) return;
    choose_cells(triangles, margin / 2);
    fill(triangles);
}

/// Longer cells where there were too many of them, however thin the box is, or too much to do to fill them.
void TriangleGrid::choose_cells(std::span<const Triangle> triangles, double edge) {
    const auto count = static_cast<double>(triangles.size());
    const double most = (margin_ > 0 ? 1048576 : 4096) + 8 * count, most_visited = 2e6 + 300 * count;
    Bounds all = bounds_around(triangles.front().corner);
    for (const Triangle& t : triangles) all.widen(bounds_around(t.corner));
    low_ = all.low, high_ = all.high;
    Vec3 extent = high_ - low_;
    for (std::size_t k = 0; k < 3; ++k) extent[k] += 2 * margin_, origin_[k] = low_[k] - margin_;
    const auto cells = [&](double h) {
        return std::ceil(extent[0] / h + 1) * std::ceil(extent[1] / h + 1) * std::ceil(extent[2] / h + 1);
    };
    while (cells(edge) > most || visited(triangles, margin_, edge) > most_visited) edge *= 1.25;
    edge_ = edge;
    for (std::size_t k = 0; k < 3; ++k) cells_[k] = static_cast<std::size_t>(std::floor(extent[k] / edge_)) + 1;
}

void TriangleGrid::fill(std::span<const Triangle> triangles) {
    // A triangle comes within the margin of a cell at most where it comes near its middle; rounding is far below the
    // 1 % beyond.
    const double near_middle = 1.01 * (std::sqrt(0.75) * edge_ + margin_);
    const auto for_each_entry = [&](auto&& visit) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            Bounds box = bounds_around(triangles[t].corner);
            for (std::size_t k = 0; k < 3; ++k) box.low[k] -= margin_, box.high[k] += margin_;
            for_each_cell(range(box.low, box.high), [&](const std::array<std::size_t, 3>& place, std::size_t cell) {
                Vec3 middle = origin_;
                for (std::size_t k = 0; k < 3; ++k) middle[k] += (static_cast<double>(place[k]) + 0.5) * edge_;
                if (triangles[t].nearest(middle).distance <= near_middle) visit(t, cell);
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

std::span<const std::uint32_t> TriangleGrid::at(const Vec3& x) const {
    if (entries_.empty()) return {};
    for (std::size_t k = 0; k < 3; ++k)
        if (!(x[k] >= low_[k] - margin_ && x[k] <= high_[k] + margin_)) return {};
    const std::size_t cell = cell_along(0, x[0]) + cells_[0] * (cell_along(1, x[1]) + cells_[1] * cell_along(2, x[2]));
    return std::span(entries_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
}

std::size_t TriangleGrid::cell_along(std::size_t axis, double x) const {
    const double last = static_cast<double>(cells_[axis] - 1);
    return static_cast<std::size_t>(std::clamp(std::floor((x - origin_[axis]) / edge_), 0.0, last));
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
