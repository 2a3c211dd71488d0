// Beyond these limits a state is not sound: the case is reported unstable and has no result.
#pragma once

#include <string>

namespace grainsweep::dem {

/// Overlap over the smaller diameter (a wall: over the diameter). Hertz's law is a small-strain law: at 0.3 the
/// contact radius sqrt(R* d) is 0.77 (equal spheres: 0.55) of the sphere's. LIGGGHTS reaches 0.10 in spreading at E =
/// 21 MPa.
inline constexpr double largest_sound_overlap = 0.3;

/// Phase through which a contact swings in one time step, dt sqrt(S_n/m*) with S_n = 2 E* sqrt(R* d) = dF/dd. The
/// explicit step is unstable at 2 for one degree of freedom; the tangential one of a sphere free to spin is up to
/// sqrt(2.9) = 1.7 times as fast as the normal one, so at 1 nothing has become unstable and nothing is resolved any
/// more.
inline constexpr double largest_sound_swing = 1.0;

/// Distance covered in one time step over the particle's own radius: beyond, contacts could be jumped over.
inline constexpr double largest_sound_displacement = 1.0;

/// Speed over the sum of the fastest start, the fastest wall, the fall through the whole domain and the release of
/// all elastic energy at the start by the lightest particle. Chains of collisions can focus momentum, but the factor
/// would need a chain of particles each much lighter than the one before.
inline constexpr double largest_sound_speed_factor = 10;

/// Energy created within some hundred steps, divided by the largest energy in motion and in contacts before and the
/// work of the walls. In 2,500 cases of few spheres at the default step, completed ones reach 7; the one that only this
/// check finds reaches 27.
inline constexpr double largest_sound_energy_gain = 15;

/// What is wrong with a contact, in words that "with" and its partner complete; empty: nothing. `share`: its overlap
/// over the smaller diameter, at most `deepest`. `swing`: rad per step.
[[nodiscard]] std::string flaw_of_contact(double share, double swing, double deepest = largest_sound_overlap);

}  // namespace grainsweep::dem
