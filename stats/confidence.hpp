// 95 % half-widths of estimates, from repetitions or from leaving out parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace grainsweep::stats {

/// Half-width of a 95 % interval in standard errors of a normal estimate.
inline constexpr double normal_95 = 1.959963984540054;

/// Factor by which errors of even points fall at the steepest where their number doubles, 2^(-3/2), and the halvings of
/// a sequence that are compared by it (convergence.hpp).
inline constexpr double steepest_fall = 0.35355339059327376;
inline constexpr std::size_t most_halvings = 3;

/// Returns t_{freedom, 0.975}, the half-width in standard errors. NaN below one degree of freedom.
[[nodiscard]] double student_factor(std::int64_t freedom);

/// Returns the quantile of Student's distribution with `freedom` > 0 degrees, finite; probability in (0, 1).
[[nodiscard]] double student_quantile(double freedom, double probability);
/// Returns the distribution function of Student's distribution.
[[nodiscard]] double student_probability(double freedom, double quantile);
/// Returns the quantile of the standard normal distribution; probability in (0, 1).
[[nodiscard]] double normal_quantile(double probability);
/// Returns the standard normal distribution function.
[[nodiscard]] double normal_cdf(double quantile);

/// Returns the Student-t 95 % half-width of the mean of independent, identically distributed values:
/// t_{R-1, 0.975} s / sqrt(R), s with divisor R - 1. NaN for fewer than two values or any NaN.
[[nodiscard]] double student_half_width(std::span<const double> values);

/// Returns the upper end of the 95 % interval of the share of a population that none of `count` independent draws has
/// shown:
/// 1 - 0.05^(1/count), about 3/count (rule of three; Hanley & Lippman-Hand 1983, J. Am. Med. Assoc. 249, 1743). 1
/// without a draw.
[[nodiscard]] double largest_unseen_share(std::int64_t count);

/// Returns the 95 % half-width of the delete-a-group jackknife (Shao & Wu 1989, Ann. Stat. 17, 1176): entry g is the
/// estimate without group g of G equal groups;
///   se^2 = (G - 1)/G sum_g (theta_g - mean)^2,  half-width t_{G-1, 0.975} se.
/// se^2 is unbiased for independent groups. For consecutive batches of one low-discrepancy sequence, which complement
/// each other, it is too large. NaN for fewer than two values or any NaN.
[[nodiscard]] double jackknife_half_width(std::span<const double> leave_one_out);

}  // namespace grainsweep::stats
