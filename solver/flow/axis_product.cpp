#include "solver/flow/axis_product.hpp"

#include "solver/flow/dense_product.hpp"

#include <algorithm>

namespace grainsweep::flow {

AxisProduct::AxisProduct(const Grid& grid, int direction, const Eigen::MatrixXd& matrix, double negligible)
    : n_{grid.cells(0), grid.cells(1), grid.cells(2)}, direction_(direction) {
    const Eigen::Index n = matrix.rows();
    for (Eigen::Index r = 0; r < n; ++r)
        for (Eigen::Index c = 0; c < n; ++c) entries_.push_back(direction == 0 ? matrix(c, r) : matrix(r, c));
    // Number of items that the product processes together: rows of the left operand or, along x, vectors of columns of
    // the right one.
    const Eigen::Index at_once = 8;
    const double least = negligible * matrix.cwiseAbs().maxCoeff();
    for (Eigen::Index row = 0; row < n; row += at_once) {
        const Eigen::Index rows = std::min(at_once, n - row);
        const auto needed = [&](Eigen::Index c) { return matrix.block(row, c, rows, 1).cwiseAbs().maxCoeff() > least; };
        Eigen::Index first = 0, end = n;
        while (end > 0 && !needed(end - 1)) --end;
        while (first < end && !needed(first)) ++first;
        Block* last = blocks_.empty() ? nullptr : &blocks_.back();
        if (last != nullptr && last->column == first && last->columns == end - first) {
            last->rows += rows;
        } else {
            blocks_.push_back({row, rows, first, end - first});
        }
    }
}

void AxisProduct::apply(const Field& from, Field& to, int first, int last) const {
    const std::ptrdiff_t n = n_[static_cast<std::size_t>(direction_)];
    const std::ptrdiff_t from_row = from.stride(direction_ == 0 ? 1 : direction_);
    const std::ptrdiff_t to_row = to.stride(direction_ == 0 ? 1 : direction_);
    for (int q = first; q <= last; ++q) {
        const double* source = from.data() + from.index(1, 1, 1) + (q - 1) * from.stride(across());
        double* target = to.data() + to.index(1, 1, 1) + (q - 1) * to.stride(across());
        for (const Block& b : blocks_) {
            if (direction_ == 0) {
                dense_product(n_[1], b.rows, b.columns, source + b.column, from_row,
                              entries_.data() + b.column * n + b.row, n, target + b.row, to_row);
            } else {
                dense_product(b.rows, n_[0], b.columns, entries_.data() + b.row * n + b.column, n,
                              source + b.column * from_row, from_row, target + b.row * to_row, to_row);
            }
        }
    }
}

void AxisProduct::apply(const Field& from, Field& to, const Slabs& slabs) const {
    slabs.over(1, n_[static_cast<std::size_t>(across())], [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        apply(from, to, static_cast<int>(first), static_cast<int>(last));
    });
}

double AxisProduct::kept() const {
    const double n = n_[static_cast<std::size_t>(direction_)];
    double entries = 0;
    for (const Block& b : blocks_) entries += static_cast<double>(b.rows) * static_cast<double>(b.columns);
    return entries / (n * n);
}

}  // namespace grainsweep::flow
