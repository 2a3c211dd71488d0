// Powder of a layer before it settles, and the walls around it.
#pragma once

#include "solver/scenes/spreading/study.hpp"

namespace grainsweep::spreading {

inline constexpr double first_gate = 0.015;    // m
inline constexpr double domain_top = 0.160;    // m, above the level
inline constexpr double spacing = 1.1;         // of the lattice, in diameters
inline constexpr double jitter = 0.05;         // in diameters; also the margin to walls
inline constexpr double start_velocity = 0.1;  // m/s

/// Returns the height of the layer at the start, m: of the lattice, or of the tray of unequal spheres.
[[nodiscard]] double start_height(const Study& study);

/// Returns a layer before it settles, from the study, the earlier layers and a seed. Order of the spheres: new powder,
/// bed, particles glued to the base. Walls: base, first and second gate; from the second layer on also the base beyond
/// the platform. `bed`: powder on the platform, empty for the first layer.
[[nodiscard]] dem::Setup settling(const Study& study, std::uint64_t seed, std::int64_t layer = 0,
                                  const dem::State& bed = {});
/// Returns base and tool; from the second layer on also the base before and beyond the platform.
[[nodiscard]] std::vector<dem::Wall> sweeping_walls(const Study& study, std::int64_t layer = 0);

/// Returns the powder that stays on the platform after spreading.
[[nodiscard]] dem::State left_on_platform(const Study& study, std::int64_t layer, const dem::State& state);
/// Returns the number of particles glued to the base.
[[nodiscard]] std::int64_t glued_particles(const Study& study);

}  // namespace grainsweep::spreading
