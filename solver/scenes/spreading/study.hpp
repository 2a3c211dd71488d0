// The spreading experiment in numbers: a flat layer between two gates settles under gravity; the gates vanish, and a
// blade at height `gap` sweeps the layer at constant speed from rest.
//
// Geometry (x along the blade's motion, y periodic, z up):
//     base z = 0; gates at x = 15 mm and 20 mm beyond the end of the travel; blade front at x = 15 mm at the start
//     start: cubic lattice of 1.1 D with jitter, +-0.05 D, and random velocities, +-0.1 m/s, per component
//     start of unequal spheres: random sequential addition at a solid fraction of 0.25, same velocities
// The particles' number is that of a solid area `layer_area` in the xz plane: N = A W / (pi/6 D^3); unequal spheres are
// drawn until their volume is as near to A W as it gets.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grainsweep::spreading {

struct Study {
    dem::Material material;
    particles::SizeDistribution sizes;  ///< of d/D
    double diameter = 0, gap = 0, speed = 0, gravity = 0;
    double vibration_amplitude = 0, vibration_frequency = 0;
    double width = 0;  ///< m
    double layer_area = 0, travel = 0, blade_thickness = 0, blade_edge_radius = 0;
    double blade_start = 0;  ///< front face of the blade when it starts, m
    double time_step = 0;
    double standard_error = 0;  ///< of mfr, at which the sweep may end; 0: never before its end
    std::int64_t bed_seed = 0;  ///< 0: the case's own
    std::string bed_key;        ///< canonical text of what determines the settled bed; empty: not shared

    std::int64_t particles = 0;  ///< of unequal sizes: the expected number
    std::int64_t settle_steps = 0, sweep_steps = 0;
    std::int64_t lattice_x = 0, lattice_y = 0;

    /// Of a sphere of diameter D.
    [[nodiscard]] double particle_mass() const;
    /// Front face of the blade, s after it started.
    [[nodiscard]] double front(double time) const;
    [[nodiscard]] double rear(double time) const { return front(time) - blade_thickness; }
};

/// Of the layer before the blade moves, m.
[[nodiscard]] double layer_length(const Study& study);

/// Throws std::invalid_argument with one sentence where the inputs are impossible together. Without files, as for an
/// estimate, sizes in a file are taken as all equal.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files* files = nullptr);

/// The layer before it settles, a pure function of the study and a seed.
[[nodiscard]] dem::Setup settling(const Study& study, std::uint64_t seed);
/// The seed of the shared bed of that number.
[[nodiscard]] std::uint64_t seed_of_bed(std::int64_t number);
/// How far before the layer the blade starts over a shared bed, m: the case's own, less than one diameter.
[[nodiscard]] double run_up(const Study& study, std::uint64_t seed);
[[nodiscard]] std::vector<dem::Wall> sweeping_walls(const Study& study);

/// Share of the travel after which the flux is steady and measuring begins: 20 of 70 mm.
inline constexpr double measured_from = 2.0 / 7.0;
/// Samples of the sweep at equal distances, and the first one that counts.
inline constexpr std::int64_t sweep_samples = 140;
inline constexpr std::int64_t first_measured_sample = 40;
/// A wanted standard error is checked after so many measured samples, and again after as many more of the second
/// number: half of the measured travel at least, and few enough checks that chance does not end the sweep.
inline constexpr std::int64_t least_measured_samples = 50;
inline constexpr std::int64_t samples_between_looks = 10;

/// Grows whenever answers change on purpose.
inline constexpr int revision = 3;

}  // namespace grainsweep::spreading
