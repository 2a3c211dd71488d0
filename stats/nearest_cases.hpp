// Whether the cases nearest to a point failed.
//
//   d^2(x, y) = sum_j [ D_j^2 (x_j - y_j) ]^2,   D_j = max |F_failed,j - F_answered,j|
//
// with coordinates of the unit cube. D_j is the Kolmogorov-Smirnov distance of coordinate j between failed and answered
// cases: a coordinate that does not decide where cases fail moves no case nearer or farther. Where only one coordinate
// of six decides, equal weights take a quarter of the failing points for answered ones (100 cases, 30 % failed), these
// weights one in a hundred.
//
// A point fails where its nearest case failed or most of its 5 nearest cases did. Cases as near as the fifth count,
// too; of several nearest cases at one distance (replicates) most decide. Nothing is fitted: failures have no model.
//
// The border lies halfway between failed and answered cases. A point is beside it that is nearer to a failed case of
// the 5 than its nearest case is: no case has shown that so near to a failed one there is an answer.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::stats {

[[nodiscard]] double squared_distance(std::span<const double> a, std::span<const double> b);

class NearestCases {
public:
    /// `rows`: coordinates, one row of `width` after the other, one row per entry of `failed`.
    NearestCases(std::vector<double> rows, std::size_t width, std::vector<bool> failed);

    struct Near {
        std::size_t cases = 0;            ///< nearest cases that were counted
        std::vector<std::size_t> failed;  ///< those that failed, by row, growing
        bool answers = true;              ///< the point does not fail
        bool beside = false;              ///< it is beside the border, or fails
    };
    [[nodiscard]] Near at(std::span<const double> point) const;
    [[nodiscard]] bool any_failed() const { return any_failed_; }

private:
    std::vector<double> rows_;  ///< times the weights
    std::vector<double> weights_;
    std::vector<bool> failed_;
    bool any_failed_ = false;
};

}  // namespace grainsweep::stats
