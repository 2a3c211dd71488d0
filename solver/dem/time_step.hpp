// Limits of the time step of an explicit DEM integration.
//
//     Rayleigh   t_R = pi R sqrt(rho/G) / (0.1631 nu + 0.8766),  G = E/(2 (1 + nu))
//                                            (Thornton & Randall 1988, in Micromechanics of Granular Materials)
//     Hertz      t_c = 2.87 (m*^2 / (R* E*^2 v))^(1/5), duration of the elastic impact at relative speed v
//                                            (Hertz 1882; Johnson 1985, Contact Mechanics, eq. 11.24)
//     linear     t_c = pi sqrt(m*/k), duration of the elastic impact at any speed
// A time step should be a fraction of the times of its law; of the linear one, of a part of it: an impact of 20 steps
// has a restitution within 0.03 of that of a fine step, one of five within 0.1. Hertz's impacts have as many, because
// Rayleigh's time is the shorter one at usual speeds. All in SI; radius, speed > 0.
#pragma once

#include "solver/dem/engine.hpp"

namespace grainsweep::dem {

/// Returns the time of a surface wave around the smallest sphere, s.
[[nodiscard]] double rayleigh_time(const Material& material, double radius);

/// Returns the duration of the elastic impact of two equal spheres at relative speed `speed`, s. It is the shortest
/// among spheres of at least this radius. An impact on a wall lasts 2^(1/5) = 1.15 times as long.
[[nodiscard]] double hertz_contact_time(const Material& material, double radius, double speed);

/// Returns the same for the linear law. An impact on a wall lasts 2^(1/2) times as long; damping makes it longer.
[[nodiscard]] double linear_contact_time(const Material& material, double radius);

/// Part of the duration of a linear impact that limits a step.
inline constexpr double part_of_linear_impact = 0.25;
/// Returns what limits a step by the impacts of two equal spheres, s: their duration, of the linear law a part of it.
[[nodiscard]] double impact_limit(const Material& material, double radius, double speed);
/// Returns the shortest of the times that limit a step with the material's law, s.
[[nodiscard]] double shortest_time(const Material& material, double radius, double speed);

/// Returns the largest share of the longest stable step of the contacts (step_control.hpp) for a step that is a
/// fraction of shortest_time(): 4 times the fraction, so that finer settings stay finer under load; at most 0.95.
[[nodiscard]] double step_share(double fraction);

}  // namespace grainsweep::dem
