// Values on a staggered grid with one ghost layer, x fastest.
#pragma once

#include "solver/flow/axis.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace grainsweep::flow {

/// Grid of three axes; the box is their product.
struct Grid {
    std::array<Axis, 3> axes;

    [[nodiscard]] const Axis& operator[](int d) const { return axes[static_cast<std::size_t>(d)]; }
    [[nodiscard]] int cells(int d) const { return (*this)[d].cells(); }
    [[nodiscard]] std::size_t total_cells() const {
        return static_cast<std::size_t>(cells(0)) * static_cast<std::size_t>(cells(1)) *
               static_cast<std::size_t>(cells(2));
    }
};

/// Field with one value per cell, or per face of one direction, including ghosts: shape (nx+2, ny+2, nz+2), indices
/// from 0.
class Field {
public:
    Field() = default;
    explicit Field(const Grid& grid)
        : row_(grid.cells(0) + 2),
          plane_(static_cast<std::ptrdiff_t>(row_) * (grid.cells(1) + 2)),
          values_(static_cast<std::size_t>(plane_ * (grid.cells(2) + 2)), 0.0) {}

    [[nodiscard]] std::ptrdiff_t index(int i, int j, int k) const { return i + j * row_ + k * plane_; }
    /// Returns the distance in memory between neighbours along a direction.
    [[nodiscard]] std::ptrdiff_t stride(int d) const { return d == 0 ? 1 : d == 1 ? row_ : plane_; }

    [[nodiscard]] double& operator()(int i, int j, int k) { return values_[static_cast<std::size_t>(index(i, j, k))]; }
    [[nodiscard]] double operator()(int i, int j, int k) const {
        return values_[static_cast<std::size_t>(index(i, j, k))];
    }
    [[nodiscard]] double* data() { return values_.data(); }
    [[nodiscard]] const double* data() const { return values_.data(); }
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    [[nodiscard]] std::vector<double>& values() { return values_; }
    [[nodiscard]] const std::vector<double>& values() const { return values_; }

private:
    std::ptrdiff_t row_ = 0;
    std::ptrdiff_t plane_ = 0;
    std::vector<double> values_;
};

/// Planes k = first ... last of a field, as far as they exist.
struct Planes {
    int first = 0;
    int last = std::numeric_limits<int>::max() / 2;
};

/// Vector field on the faces: component d is on the faces of direction d.
using FaceVectors = std::array<Field, 3>;

[[nodiscard]] inline FaceVectors face_vectors(const Grid& grid) {
    return {Field(grid), Field(grid), Field(grid)};
}

}  // namespace grainsweep::flow
