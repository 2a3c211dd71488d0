// Matrix applied along one axis of a field: every line a -> M a.
//
// The matrices here are exponentials and inverses of second differences: dense, but their entries fall off like a
// Gaussian or an exponential with the distance from the diagonal. Entries below 1e-17 of the largest are skipped,
// separately for each block of rows. A line of n values changes by less than n 1e-17 of its largest value, which is
// less than rounding.
#pragma once

#include "solver/flow/field.hpp"
#include "solver/threads/slabs.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace grainsweep::flow {

class AxisProduct {
public:
    AxisProduct() = default;
    /// matrix: n x n for indices 1 ... n along `direction`. Entries up to `negligible` times the largest may be
    /// skipped.
    AxisProduct(const Grid& grid, int direction, const Eigen::MatrixXd& matrix, double negligible = 1e-17);

    /// Computes the inner values of `to` from those of `from`, another field; ghosts do not change.
    void apply(const Field& from, Field& to, const Slabs& slabs = {}) const;
    /// Computes only the lines with indices first ... last on the axis across(), from 1.
    void apply(const Field& from, Field& to, int first, int last) const;
    /// Returns the axis along which the lines are numbered: z, or y for lines along z.
    [[nodiscard]] int across() const { return direction_ == 2 ? 1 : 2; }
    /// Returns the share of the matrix that is multiplied.
    [[nodiscard]] double kept() const;

private:
    /// Rows of the matrix, and the range of columns in which their entries are not negligible.
    struct Block {
        std::ptrdiff_t row = 0, rows = 0, column = 0, columns = 0;
    };
    std::array<int, 3> n_{};
    int direction_ = 0;
    std::vector<double> entries_;  // row-major; along x, where the field stands on the left of the product, transposed
    std::vector<Block> blocks_;
};

}  // namespace grainsweep::flow
