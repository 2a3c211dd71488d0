// The closed response that the convergence study of the reference numbers was made with: a mass flow rate
// under a blade over friction 0.1-0.3, diameter 1-3 mm, gap 1-5 mm, speed 1.2-1.6 m/s (u in [0, 1]^4).
// Zero up to gap/diameter = onset, then saturating. The moments of onset 1 ("model A") are known.
#pragma once

#include <cmath>
#include <span>

namespace grainsweep::tests {

inline double spreading_response(std::span<const double> u, double onset = 1.0) {
    const double friction = 0.1 + 0.2 * u[0];
    const double diameter = 1 + 2 * u[1];
    const double gap = 1 + 4 * u[2];
    const double speed = 1.2 + 0.4 * u[3];
    const double r = gap / diameter;
    if (r <= onset) return 0;
    const double r0 = 0.8 * (1 + 0.8 * (friction - 0.2));
    return 0.62 * (1 - 0.5 * (friction - 0.2)) * (1 - 0.25 * (speed - 1.4)) * (1 - std::exp(-(r - 1) / r0));
}

/// Model A.
inline constexpr double spreading_mean = 0.270150;
inline constexpr double spreading_sd = 0.214471;
inline constexpr double spreading_skewness = -0.236620;
inline constexpr double spreading_kurtosis = 1.559886;

}  // namespace grainsweep::tests
