// Mean, sd, g1 and kurtosis as functions of the raw moments M_1 ... M_4, with their gradients (delta method).
//
//   V = M2 - M1^2,  mu3 = M3 - 3 M1 M2 + 2 M1^3,  mu4 = M4 - 4 M1 M3 + 6 M1^2 M2 - 3 M1^4
//   sd = sqrt(V), g1 = mu3/V^(3/2), kurtosis = mu4/V^2
#pragma once

#include <array>

namespace grainsweep::stats {

using RawMoments = std::array<double, 4>;

/// Returns V, mu3, mu4.
[[nodiscard]] std::array<double, 3> central_moments(const RawMoments& m);

struct MomentStatistic {
    double value = 0;
    RawMoments gradient{};  ///< by M_1 ... M_4
};

/// Returns mean, sd, g1, kurtosis. NaN if V is not positive.
[[nodiscard]] std::array<MomentStatistic, 4> moment_statistics(const RawMoments& m);

}  // namespace grainsweep::stats
