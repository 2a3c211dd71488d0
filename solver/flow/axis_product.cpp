#include "solver/flow/axis_product.hpp"

#include "solver/flow/dense_product.hpp"

namespace grainsweep::flow {

AxisProduct::AxisProduct(const Grid& grid, int direction, const Eigen::MatrixXd& matrix)
    : n_{grid.cells(0), grid.cells(1), grid.cells(2)}, direction_(direction) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r)
        for (Eigen::Index c = 0; c < matrix.cols(); ++c)
            entries_.push_back(direction == 0 ? matrix(c, r) : matrix(r, c));
}

void AxisProduct::apply(const Field& from, Field& to) const {
    const int n = n_[static_cast<std::size_t>(direction_)];
    const int across = direction_ == 2 ? 1 : 2;  // the axis of the outer loop
    for (int q = 1; q <= n_[static_cast<std::size_t>(across)]; ++q) {
        const std::ptrdiff_t start = from.index(1, 1, 1) + (q - 1) * from.stride(across);
        if (direction_ == 0) {
            dense_product(n_[1], n, n, from.data() + start, from.stride(1), entries_.data(), n, to.data() + start,
                          to.stride(1));
        } else {
            dense_product(n, n_[0], n, entries_.data(), n, from.data() + start, from.stride(direction_),
                          to.data() + start, to.stride(direction_));
        }
    }
}

}  // namespace grainsweep::flow
