// Grid of cubic cells over a set of triangles. Each cell lists the triangles that reach into it or come within a margin
// of it.
#pragma once

#include "solver/geometry/triangle.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::geometry {

class TriangleGrid {
public:
    TriangleGrid() = default;
    explicit TriangleGrid(std::span<const Triangle> triangles);
    /// Makes cells about half as long as the margin, or longer if there were too many. at() finds all triangles nearer
    /// than the margin.
    TriangleGrid(std::span<const Triangle> triangles, double margin);

    /// Return the corners of the box around all triangles.
    [[nodiscard]] const Vec3& low() const { return low_; }
    [[nodiscard]] const Vec3& high() const { return high_; }

    /// Lists all triangles that reach into the box, ascending, and some others near it.
    void in_box(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& into) const;
    /// Returns all triangles within the margin of the place, ascending, and some farther away.
    [[nodiscard]] std::span<const std::uint32_t> at(const Vec3& x) const;

private:
    using Range = std::array<std::size_t, 2>;  // first and last

    void choose_cells(std::span<const Triangle> triangles, double edge);
    void fill(std::span<const Triangle> triangles);
    [[nodiscard]] std::size_t cell_along(std::size_t axis, double x) const;
    [[nodiscard]] std::array<Range, 3> range(const Vec3& low, const Vec3& high) const;
    template <class Visit>
    void for_each_cell(const std::array<Range, 3>& box, Visit&& visit) const;

    Vec3 low_{}, high_{};
    double margin_ = 0;
    Vec3 origin_{};                       // of the cells: low_ less the margin
    double edge_ = 1;                     // of a cell, m
    std::array<std::size_t, 3> cells_{};  // along each axis
    std::vector<std::uint32_t> begin_;    // of a cell's part of entries_
    std::vector<std::uint32_t> entries_;  // triangles, ascending in each cell
};

}  // namespace grainsweep::geometry
