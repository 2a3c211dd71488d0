// Limits of a sound state. Beyond them the case is reported as unstable and has no result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace grainsweep::dem {

/// Largest overlap divided by the smaller diameter (at a wall: by the diameter). Hertz's law is valid for small
/// strains: at 0.3 the contact radius sqrt(R* d) is 0.77 of the sphere's radius (equal spheres: 0.55). LIGGGHTS reaches
/// 0.10 in spreading at E = 21 MPa.
inline constexpr double largest_sound_overlap = 0.3;

/// Largest phase of a contact's oscillation in one time step, dt sqrt(S_n/m*) with S_n = 2 E* sqrt(R* d) = dF/dd. The
/// explicit step is unstable at 2 for one degree of freedom. The tangential oscillation of a freely rotating sphere is
/// up to sqrt(2.9) = 1.7 times as fast as the normal one. So at 1 no oscillation is unstable yet, but none is resolved
/// any more.
inline constexpr double largest_sound_swing = 1.0;

/// Largest distance covered in one time step divided by the particle's radius; larger steps could miss contacts.
inline constexpr double largest_sound_displacement = 1.0;

/// Largest speed divided by the sum of four speeds: the fastest start, the fastest wall, the fall through the whole
/// domain, and the lightest particle with all elastic energy of the start. Chains of collisions can focus momentum, but
/// to exceed the factor, each particle of the chain must be much lighter than the one before.
inline constexpr double largest_sound_speed_factor = 10;

/// Largest energy created within some hundred steps, divided by the largest earlier energy in motion and in contacts
/// plus the work of the walls. In 2,500 cases of few spheres at the default step, completed cases reach 7; the only
/// case found by this check alone reaches 27.
inline constexpr double largest_sound_energy_gain = 15;

/// Depth of a frozen sphere in a wall that forces move, divided by its diameter, beyond which the case ends: there is
/// no contact between them.
inline constexpr double deepest_frozen = 0.05;

/// Returns the fault of a contact in words that "with" and its partner follow; empty: none. `share`: its overlap
/// divided by the smaller diameter, at most `deepest`. `swing`: rad per step.
[[nodiscard]] std::string flaw_of_contact(double share, double swing, double deepest = largest_sound_overlap);
/// Returns the fault of a particle that is faster than the limit of the case, m/s.
[[nodiscard]] std::string flaw_of_speed(double speed, double limit);
/// Returns the fault of a wall with this number that moves at a speed, m/s; empty: none. In a step of a length, s, it
/// must not move farther than the smallest radius, m.
[[nodiscard]] std::string flaw_of_wall_speed(std::size_t wall, double speed, double step, double smallest_radius,
                                             std::int64_t steps);
/// Returns the end of a fault: its particle with the place, m, the steps so far, and the time, s.
[[nodiscard]] std::string place_and_time(std::int32_t id, const std::array<double, 3>& place, std::int64_t steps,
                                         double time);
/// Returns the fault of a wall with this number that a frozen sphere lies in.
[[nodiscard]] std::string flaw_of_frozen(std::size_t wall);

}  // namespace grainsweep::dem
