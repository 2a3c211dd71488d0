// 95 % half-widths: how far an estimate may be off, from repetitions or from leaving parts out.
#pragma once

#include <cstdint>
#include <span>

namespace grainsweep::stats {

/// t_{freedom, 0.975}: half-widths in standard errors. NaN below one degree of freedom.
[[nodiscard]] double student_factor(std::int64_t freedom);

/// Quantile of Student's distribution of `freedom` > 0 degrees, finite; probability in (0, 1).
[[nodiscard]] double student_quantile(double freedom, double probability);
/// Its distribution function.
[[nodiscard]] double student_probability(double freedom, double quantile);
/// Quantile of the normal distribution of mean 0 and standard deviation 1; probability in (0, 1).
[[nodiscard]] double normal_quantile(double probability);
/// Its distribution function.
[[nodiscard]] double normal_cdf(double quantile);

/// Student-t 95 % half-width of the mean of independent, equally distributed values:
/// t_{R-1, 0.975} s / sqrt(R), s with divisor R - 1. NaN for fewer than two values or any NaN.
[[nodiscard]] double student_half_width(std::span<const double> values);

/// Upper end of the 95 % interval of the share of a population that `count` independent draws have not shown:
/// 1 - 0.05^(1/count), about 3/count (rule of three; Hanley & Lippman-Hand 1983, J. Am. Med. Assoc. 249, 1743). 1
/// without a draw.
[[nodiscard]] double largest_unseen_share(std::int64_t count);

/// 95 % half-width from the delete-a-group jackknife (Shao & Wu 1989, Ann. Stat. 17, 1176): entry g is the
/// estimate without group g of G equal groups;
///   se^2 = (G - 1)/G sum_g (theta_g - mean)^2,  half-width t_{G-1, 0.975} se.
/// Exact in expectation for independent groups; for consecutive stretches of one low-discrepancy sequence,
/// which complement each other, it errs on the large side. NaN as above.
[[nodiscard]] double jackknife_half_width(std::span<const double> leave_one_out);

}  // namespace grainsweep::stats
