// Discharge of grains through an opening in the floor of a hopper.
//
//     W = C rho_b sqrt(g) (D - k d)^(5/2),   C = 0.58, k = 1.4
//
// W: mass per time; rho_b = phi rho: bulk density of a packing of volume fraction phi (Beverloo, Leniger & van de Velde
// 1961, Chem. Eng. Sci. 15, 260; k for spheres from there). Valid for cohesionless grains and a round opening, well
// above the size of a grain and small compared with the hopper.
#pragma once

#include <cmath>
#include <numbers>

namespace grainsweep::observables {

/// Returns the grains per second through an opening of diameter `opening` (m); 0 if D <= k d.
[[nodiscard]] inline double beverloo_rate(double opening, double diameter, double packing_fraction, double gravity) {
    constexpr double c = 0.58, k = 1.4;
    const double free = opening - k * diameter;
    if (!(free > 0)) return 0;
    const double volume_rate = c * packing_fraction * std::sqrt(gravity) * std::pow(free, 2.5);
    return volume_rate / (std::numbers::pi / 6 * diameter * diameter * diameter);
}

}  // namespace grainsweep::observables
