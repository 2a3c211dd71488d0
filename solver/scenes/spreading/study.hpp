// The spreading experiment in numbers: a flat layer between two gates settles under gravity; the gates vanish, and a
// tool (tool.hpp) at height `gap` sweeps the layer at constant speed from rest.
//
// Geometry (x along the travel, y periodic, z up):
//     base z = 0; gates at x = 15 mm and `layer_beyond` beyond the end of the travel; the tool's foremost point is at
//     x = 15 mm at the start
//     start: cubic lattice of 1.1 D with jitter, +-0.05 D, and random velocities, +-0.1 m/s, per component
//     start of unequal spheres: random sequential addition at a solid fraction of 0.25, same velocities
// The particles' number is that of a solid area `layer_area` in the xz plane: N = A W / (pi/6 D^3); unequal spheres are
// drawn until their volume is as near to A W as it gets.
//
// Several layers: layer k = 0, 1, ... is spread at height gap over the level k gap, which is a platform sinking by the
// gap after each layer, seen from the platform. It reaches from the first gate to where the tool's edge stops; before
// and beyond it the base rises with the level. What lies there after a sweep, or whole above the tool's lowest
// point, is taken away; new powder settles on the rest between the gates. Contacts between the particles of a bed
// start anew with each layer: their tangential springs and, of adhesive ones, what holds without touch.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/spreading/tool.hpp"
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
    double layer_area = 0, layer_beyond = 0, travel = 0;
    Tool tool = Tool::blade;
    double blade_thickness = 0, blade_edge_radius = 0, roller_diameter = 0, roller_spin = 0;
    geometry::Mesh surface;  ///< of a tool from a file, fitted()
    double ahead = 0;        ///< of the tool's foremost point before its edge, m
    double behind = 0;       ///< of its rear behind its edge, m
    double clearance = 0;    ///< behind its rear, where the powder has come to rest, m
    double blade_start = 0;  ///< foremost point of the tool when it starts, m
    Base base = Base::smooth;
    std::int64_t layers = 1;
    double time_step = 0;
    double standard_error = 0;  ///< of mfr, at which the sweep may end; 0: never before its end
    std::int64_t bed_seed = 0;  ///< 0: the case's own
    std::string bed_key;        ///< canonical text of what determines the settled bed; empty: not shared

    std::int64_t particles = 0;  ///< of unequal sizes: the expected number
    std::int64_t settle_steps = 0, sweep_steps = 0;
    std::int64_t lattice_x = 0, lattice_y = 0;

    /// Of a sphere of diameter D.
    [[nodiscard]] double particle_mass() const;
    /// Planes of the tool, s after it started.
    [[nodiscard]] double front(double time) const;
    [[nodiscard]] double edge(double time) const { return front(time) - ahead; }
    [[nodiscard]] double rear(double time) const { return edge(time) - behind; }
    /// On which layer number `layer`, from 0, is spread, m.
    [[nodiscard]] double level(std::int64_t layer) const { return static_cast<double>(layer) * gap; }
    /// Settling and sweep.
    [[nodiscard]] std::int64_t steps_of_layer() const { return settle_steps + sweep_steps; }
    /// Where several layers are spread on top of each other.
    [[nodiscard]] double start_of_platform() const;
    [[nodiscard]] double end_of_platform() const { return edge(time_step * static_cast<double>(sweep_steps)); }
};

/// Of the layer before the tool moves, m.
[[nodiscard]] double layer_length(const Study& study);

/// Throws std::invalid_argument with one sentence where the inputs are impossible together or a file is not given.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files& files);

/// The seed of the shared bed of that number.
[[nodiscard]] std::uint64_t seed_of_bed(std::int64_t number);
/// How far before the layer the tool starts over a shared bed, m: the case's own, less than one diameter.
[[nodiscard]] double run_up(const Study& study, std::uint64_t seed);

/// Random loose packing: a settled layer is no higher than that makes it.
inline constexpr double settled_fraction = 0.55;
/// Share of the travel after which the flux is steady and measuring begins: 20 of 70 mm.
inline constexpr double measured_from = 2.0 / 7.0;
/// Samples of the sweep at equal distances, and the first one that counts.
inline constexpr std::int64_t sweep_samples = 140;
inline constexpr std::int64_t first_measured_sample = 40;
/// Samples before the first check of a wanted standard error, and between checks: at least half of the measured travel,
/// and so few checks that chance does not end the case early.
inline constexpr std::int64_t least_measured_samples = 50;
inline constexpr std::int64_t samples_between_looks = 10;

/// Grows whenever answers change on purpose.
inline constexpr int revision = 3;

}  // namespace grainsweep::spreading
