// The powder of a layer before it settles, and the walls around it.
#pragma once

#include "solver/scenes/spreading/study.hpp"

namespace grainsweep::spreading {

inline constexpr double first_gate = 0.015;    // m
inline constexpr double domain_top = 0.160;    // m, over the level
inline constexpr double spacing = 1.1;         // of the lattice, in diameters
inline constexpr double jitter = 0.05;         // in diameters; also the margin to walls
inline constexpr double start_velocity = 0.1;  // m/s

/// Height of the layer at the start: of the lattice, or of the tray unequal spheres are added to, m.
[[nodiscard]] double start_height(const Study& study);

/// A layer before it settles, a pure function of the study, the layers below and a seed. The spheres: first the new
/// powder, then the bed, then what is glued to the base. Walls: base, first and second gate; from the second
/// layer on the base beyond the platform. `bed`: what lies on the platform, of the first layer nothing.
[[nodiscard]] dem::Setup settling(const Study& study, std::uint64_t seed, std::int64_t layer = 0,
                                  const dem::State& bed = {});
/// Base and tool; from the second layer on the base before and beyond the platform.
[[nodiscard]] std::vector<dem::Wall> sweeping_walls(const Study& study, std::int64_t layer = 0);

/// What stays on the platform when the layer has been spread.
[[nodiscard]] dem::State left_on_platform(const Study& study, std::int64_t layer, const dem::State& state);
/// How many particles are glued to the base.
[[nodiscard]] std::int64_t glued_particles(const Study& study);

}  // namespace grainsweep::spreading
