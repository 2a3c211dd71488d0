// What the laws need of one material shared by particles and walls.
//
//     1/E* = 2 (1 - nu^2)/E          1/G* = 4 (2 - nu)(1 + nu)/E         beta = ln e / sqrt(ln^2 e + pi^2)
//
// Hertz (1882), Mindlin (1949). (Wu 2020, eq. 2, prints (1 - nu)^2: a misprint. Gupta, eq. 11, drops the sign of
// beta, which is negative for e < 1.)
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/laws/cohesion.hpp"
#include "solver/dem/laws/hertz.hpp"
#include "solver/dem/laws/mindlin.hpp"
#include "solver/dem/laws/rolling.hpp"

namespace grainsweep::dem {

[[nodiscard]] double effective_modulus(const Material& material);        ///< E*, Pa
[[nodiscard]] double effective_shear_modulus(const Material& material);  ///< G*, Pa
[[nodiscard]] double damping_ratio(double restitution);                  ///< beta, <= 0; restitution in (0, 1]
[[nodiscard]] double sphere_mass(double radius, double density);         ///< kg

/// The material as it is in contacts with a wall of this surface.
[[nodiscard]] Material at_surface(const Material& material, const Surface& surface);

[[nodiscard]] Hertz hertz(const Material& material);
[[nodiscard]] Mindlin mindlin(const Material& material, double time_step);  ///< without friction: no force at all
[[nodiscard]] RollingResistance rolling_resistance(const Material& material, double time_step);

}  // namespace grainsweep::dem
