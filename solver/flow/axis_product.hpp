// A matrix applied along one axis of a field: every line a -> M a.
#pragma once

#include "solver/flow/field.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace grainsweep::flow {

class AxisProduct {
public:
    AxisProduct() = default;
    /// matrix: n x n for indices 1 ... n along `direction`.
    AxisProduct(const Grid& grid, int direction, const Eigen::MatrixXd& matrix);

    /// Inner values of `to` from those of `from`, another field; ghosts are left alone.
    void apply(const Field& from, Field& to) const;

private:
    std::array<int, 3> n_{};
    int direction_ = 0;
    std::vector<double> entries_;  // row-major; along x, where the field stands on the left of the product, transposed
};

}  // namespace grainsweep::flow
