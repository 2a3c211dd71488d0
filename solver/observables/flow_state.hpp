// Observables of a flow: energy, heat transfer, speed, and the dimensionless numbers of thermovibrational convection.
#pragma once

#include "solver/flow/boundary.hpp"

namespace grainsweep::observables {

/// Returns the volume mean of |V|^2/2, each component weighted with the control volumes of its faces.
[[nodiscard]] double kinetic_energy(const flow::Grid& grid, const flow::FaceVectors& velocity);

/// Returns the largest |V_d| of the faces.
[[nodiscard]] double peak_velocity(const flow::Grid& grid, const flow::FaceVectors& velocity);

/// Returns the mean of L |dtheta/dn| over the side of axis d (0 low, 1 high) at temperature `wall`, for a temperature
/// difference of 1. It equals the flux in the discrete energy balance.
[[nodiscard]] double nusselt(const flow::Grid& grid, const flow::Field& temperature, int d, int side, double wall);

/// Returns Gs = (Pr/2)(Ra_omega/Omega)^2 = (b omega beta_T DT L)^2/(2 nu alpha) (Gershuni & Lyubimov 1998).
[[nodiscard]] double gershuni(double prandtl, double rayleigh, double frequency);

}  // namespace grainsweep::observables
