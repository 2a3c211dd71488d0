// Spreading experiment in numbers. A flat layer between two gates settles under gravity. Then the gates are removed,
// and a tool (tool.hpp) at height `gap` moves over the layer at constant speed from rest.
//
// Geometry (x along the travel, y periodic, z up):
//     base      z = 0
//     gates     at x = 15 mm, and `layer_beyond` beyond the end of the travel
//     tool      its foremost point is at x = 15 mm at the start
//     start     equal spheres: cubic lattice of 1.1 D with jitter, +-0.05 D, and random velocities, +-0.1 m/s, per
//               component; unequal spheres: random sequential addition at a solid fraction of 0.25, same velocities
// The number of particles gives the solid area A = `layer_area` in the xz plane: N = A W / (pi/6 D^3). Unequal spheres
// are drawn until their volume is nearest to A W.
//
// Several layers: layer k = 0, 1, ... is spread at height gap above the level k gap. This corresponds to a platform
// that sinks by the gap after each layer, in the frame of the platform. The platform reaches from the first gate to the
// end of the tool's edge; before and beyond it the base rises with the level. After a sweep, powder there, and
// particles completely above the tool's lowest point, are removed. New powder settles on the rest between the gates.
// Contacts between the particles of a bed start anew with each layer, without tangential springs and adhesion beyond
// touch.
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
    geometry::Mesh surface;  ///< of a tool from a file, after fitted()
    double ahead = 0;        ///< distance of the tool's foremost point before its edge, m
    double behind = 0;       ///< distance of its rear behind its edge, m
    double clearance = 0;    ///< distance behind its rear at which the powder is at rest, m
    double blade_start = 0;  ///< foremost point of the tool at its start, m
    Base base = Base::smooth;
    std::int64_t layers = 1;
    double time_step = 0;
    std::optional<double> step_share;  ///< of dem::Setup
    double standard_error = 0;         ///< of mfr, at which the sweep may end early; 0: never
    std::int64_t bed_seed = 0;         ///< 0: the case's own
    std::string bed_key;               ///< canonical text of the data that determine the settled bed; empty: not shared

    std::int64_t particles = 0;  ///< for unequal sizes the expected number
    std::int64_t settle_steps = 0, sweep_steps = 0;
    std::int64_t lattice_x = 0, lattice_y = 0;

    /// Returns the mass of a sphere of diameter D.
    [[nodiscard]] double particle_mass() const;
    /// Return the planes of the tool at a time after its start, s.
    [[nodiscard]] double front(double time) const;
    [[nodiscard]] double edge(double time) const { return front(time) - ahead; }
    [[nodiscard]] double rear(double time) const { return edge(time) - behind; }
    /// Returns the level on which layer `layer`, from 0, is spread, m.
    [[nodiscard]] double level(std::int64_t layer) const { return static_cast<double>(layer) * gap; }
    /// Returns the steps of settling and sweep.
    [[nodiscard]] std::int64_t steps_of_layer() const { return settle_steps + sweep_steps; }
    /// Return the ends of the platform for several layers.
    [[nodiscard]] double start_of_platform() const;
    [[nodiscard]] double end_of_platform() const { return edge(time_step * static_cast<double>(sweep_steps)); }
};

/// Returns the length of the layer before the tool moves, m.
[[nodiscard]] double layer_length(const Study& study);

/// Returns the study of a case. Throws std::invalid_argument with one sentence if the combination of inputs is
/// impossible or a file is not given.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files& files);

/// Returns the seed of the shared bed with this number.
[[nodiscard]] std::uint64_t seed_of_bed(std::int64_t number);
/// Returns the distance before the layer at which the tool starts over a shared bed, m: different for each case, less
/// than one diameter.
[[nodiscard]] double run_up(const Study& study, std::uint64_t seed);

/// Fraction of random loose packing, for an upper bound of the height of a settled layer.
inline constexpr double settled_fraction = 0.55;
/// Share of the travel after which the flux is steady and measurement begins: 20 of 70 mm.
inline constexpr double measured_from = 2.0 / 7.0;
/// Number of samples of the sweep at equal distances, and the first measured one.
inline constexpr std::int64_t sweep_samples = 140;
inline constexpr std::int64_t first_measured_sample = 40;
/// Samples before the first check of a wanted standard error: at least half of the measured travel. Checks are few, so
/// that chance does not end the case early.
inline constexpr std::int64_t least_measured_samples = 50;
inline constexpr std::int64_t samples_between_looks = 10;

/// Revision; raised whenever answers change on purpose.
inline constexpr int revision = 5;

}  // namespace grainsweep::spreading
