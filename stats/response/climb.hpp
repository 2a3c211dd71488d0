// Maximiser of a smooth function within bounds: L-BFGS (Nocedal 1980; Liu & Nocedal 1989; NLopt's LD_LBFGS).
#pragma once

#include <Eigen/Core>

#include <functional>

namespace grainsweep::stats::response {

/// Function that returns its value at a point and sets the gradient; minus infinity where it is undefined.
using Ascent = std::function<double(const Eigen::VectorXd& at, Eigen::VectorXd& gradient)>;

struct Bounds {
    Eigen::VectorXd low, high;
};

struct Climbed {
    double value = 0;
    Eigen::VectorXd at;
};

/// Returns the best point of the search, because L-BFGS may end at a worse one. Returns `from` with minus infinity if
/// no point has a value. Ends when a step gains less than `tolerance`, or after `most_looks` evaluations.
[[nodiscard]] Climbed climb(const Ascent& function, const Eigen::VectorXd& from, const Bounds& bounds, double tolerance,
                            int most_looks);

}  // namespace grainsweep::stats::response
