// Inputs of a thermovibration case as numbers, and the objects made from them.
//
// Unit cube [-1/2, 1/2]^3, length L, time L^2/alpha, theta = (T - T0)/DT. Vibration along y; hot wall z = +1/2, cold
// wall z = -1/2, the other four insulated; no slip everywhere. Start: fluid at rest, theta = z (conduction).
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/granular.hpp"
#include "solver/coupling/hysteretic_spring.hpp"
#include "solver/flow/flow.hpp"
#include "solver/scenes/thermovibration/levels.hpp"
#include "solver/scenes/values.hpp"

#include <cstdint>
#include <string>

namespace grainsweep::thermovibration {

/// Inputs of a case as numbers.
struct Question {
    double rayleigh, frequency, start_phase, acceleration, prandtl, density_ratio, stokes;
    std::int64_t particles;
    const LevelInfo* level;  ///< level of the coupling; one-way without particles
    std::string own_wake, wall_contact, particle_start, contact, symmetry;
    double restitution, collision_restitution, friction, overlap, packing_limit, granular_temperature;
    std::int64_t cells;
    double clustering;
    std::int64_t steps_per_period;
    double kernel_width;
    double time_step, end_time;
    std::int64_t sampling_cells;

    explicit Question(const Inputs& inputs);

    [[nodiscard]] bool steady_force() const { return frequency == 0; }
    [[nodiscard]] double period() const;             ///< 2 pi/Omega
    [[nodiscard]] double step() const;               ///< dt: a fraction of the period, or time_step for a steady force
    [[nodiscard]] std::int64_t window() const;       ///< steps over which the flow is averaged: a period, or one step
    [[nodiscard]] std::int64_t total_steps() const;  ///< whole windows nearest to end_time, at least one
    /// Returns the steps between samples of the particles: whole windows, about 200 samples in a run.
    [[nodiscard]] std::int64_t sample_steps() const;

    [[nodiscard]] flow::Vibration vibration() const { return {frequency, start_phase}; }
    [[nodiscard]] flow::Grid grid() const;
    [[nodiscard]] static flow::Sides sides();
    /// Returns whether only the half x < 0 of the fluid is computed, because the flow is taken as symmetric.
    [[nodiscard]] bool mirrored() const { return symmetry == "mirror" && !level->acts_on_fluid; }
    [[nodiscard]] flow::Grid flow_grid() const;
    [[nodiscard]] flow::Flow<flow::Boussinesq> fluid() const;
    [[nodiscard]] coupling::Sphere sphere() const { return {density_ratio, stokes, prandtl, acceleration, 1}; }
    /// Returns the standard deviation of the kernel that spreads particles (coupling/spreading.hpp).
    [[nodiscard]] double kernel() const { return kernel_width * 2 * sphere().radius(); }
    [[nodiscard]] coupling::Walls walls() const;
    /// Returns random particles, without overlaps if contacts are resolved. Throws std::invalid_argument if they do not
    /// fit.
    [[nodiscard]] coupling::Cloud cloud(std::uint64_t seed) const;
    /// Returns whether particles are released into a flow that has become periodic.
    [[nodiscard]] bool carried() const {
        return particles > 0 && !level->acts_on_fluid && particle_start == "periodic_flow" && !steady_force();
    }
    [[nodiscard]] coupling::Granular grains() const {
        return coupling::Granular::of(sphere(), collision_restitution, packing_limit);
    }
    [[nodiscard]] coupling::HystereticSpring spring() const;
    /// Returns a canonical text of the data that determine the periodic flow.
    [[nodiscard]] std::string flow_key() const;
};

}  // namespace grainsweep::thermovibration
