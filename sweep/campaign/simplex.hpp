// Shares that add to one: compositions of a powder, parts of a mixture.
//
// With d shares x_k >= low_k, sum x_k = 1, a point (u_1 ... u_(d-1)) of the unit cube is mapped by breaking a stick of
// length r_1 = 1 - sum low_k:
//
//   x_k = low_k + r_k (1 - (1 - u_k)^(1/(d - k))),   r_(k+1) = r_k - (x_k - low_k),   x_d = 1 - sum of the others
//
// 1 - (1 - u)^(1/b) is the quantile function of the beta distribution (1, b). So for uniform u the shares are uniform
// on the simplex, the Dirichlet distribution with parameters 1 (Devroye 1986, Non-Uniform Random Variate Generation,
// chapter XI.4). A design keeps all its coordinates; the coordinate of the last share is not used.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <span>
#include <vector>

namespace grainsweep::campaign {

/// Returns the shares at the coordinates `u` in [0, 1], one per lower end; the last coordinate is not used.
[[nodiscard]] std::vector<double> shares_at(std::span<const double> u, std::span<const double> low);
/// Replaces the coordinates of the factors that are shares by the coordinates at which value_at() returns their shares.
void share_out(std::span<const Factor> factors, std::span<double> u);
/// Returns whether shares add to one, up to rounding by 1e-9.
[[nodiscard]] bool add_to_one(std::span<const double> shares);

}  // namespace grainsweep::campaign
