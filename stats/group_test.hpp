// Test whether two groups of points come from one distribution, without an assumption about the distribution.
//
//   T_0 = 2 E|X - Y| - E|X - X'| - E|Y - Y'|        energy distance of all features (Szekely & Rizzo 2004, InterStat 5)
//   T_j = 2 integral (F(x_j) - G(x_j))^2 dx_j       the same of feature j alone, F and G the two empirical functions
//
// X, Y: points of the two groups, features scaled to their box. If the group does not depend on the features, every
// assignment of the labels to the points is equally likely. Each T is standardised by its mean and standard deviation
// over 999 permutations of the labels. The p value of a T is the share of permutations whose largest T is at least as
// large, so that several features are no repeated look (Westfall & Young 1993, section 2.3.4).
#pragma once

#include "stats/response_model.hpp"

#include <span>
#include <vector>

namespace grainsweep::stats {

/// Probabilities of differences as large as the observed ones, if the group depends on no feature. The smallest
/// possible value is 0.001.
struct GroupTest {
    double p_value = 1;                ///< of any difference
    std::vector<double> p_of_feature;  ///< of a difference in this feature, corrected for the number of features
};

/// Returns the test. Of more than 1,000 points, a random choice is used: all of the smaller group up to 500, the rest
/// of the other. `low`, `high`: box of the features. 1 everywhere if a group is empty. The same input gives the same
/// result. Throws std::invalid_argument if sizes do not match or a number is not finite.
[[nodiscard]] GroupTest compare_groups(Rows points, const std::vector<bool>& in_first, std::span<const double> low,
                                       std::span<const double> high);

}  // namespace grainsweep::stats
