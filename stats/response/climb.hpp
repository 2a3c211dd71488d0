// Maximum of a smooth function within bounds by L-BFGS (Nocedal 1980; Liu & Nocedal 1989; NLopt's LD_LBFGS).
#pragma once

#include <Eigen/Core>

#include <functional>

namespace grainsweep::stats::response {

/// Value at a point and its gradient there; minus infinity where it has none.
using Ascent = std::function<double(const Eigen::VectorXd& at, Eigen::VectorXd& gradient)>;

struct Bounds {
    Eigen::VectorXd low, high;
};

struct Climbed {
    double value = 0;
    Eigen::VectorXd at;
};

/// The best point that the search looked at: L-BFGS may end on a worse one. `from`, with minus infinity, where no point
/// has a value. Ends where a step gains less than `tolerance`, or after `most_looks`.
[[nodiscard]] Climbed climb(const Ascent& function, const Eigen::VectorXd& from, const Bounds& bounds, double tolerance,
                            int most_looks);

}  // namespace grainsweep::stats::response
