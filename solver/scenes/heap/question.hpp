// What a case of the heap is asked. study.hpp has the geometry.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::heap::question {

using kit::above;

/// Glass-like beads of 5 mm, softened.
inline constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.diameter = p.diameter.with(0.005, {1e-6, 0.1});
    p.density = p.density.with(2500, {100, 25000});
    p.youngs_modulus = p.youngs_modulus.with(5e6, {1e5, 1e12});
    p.friction = p.friction.with(0.4, {0, 2});
    p.rolling_friction = p.rolling_friction.with(0.1, {0, 1});
    p.wall_friction =
        p.wall_friction.with("Coulomb friction at tube and plate; -1: friction", kit::as_powder, {kit::as_powder, 2});
    return p;
}();

inline constexpr kit::Real tube_diameter{"tube_diameter", "m", "inner diameter of the tube", 0.06, {1e-5, 10}};
inline constexpr kit::Real lift_speed{"lift_speed", "m/s", "speed of the tube, upwards", 0.1, above(0, 100)};
inline constexpr kit::Whole particles{"particles", "number of particles", 2000, {1, 5e6}};
enum class Floor { smooth, rough };
inline constexpr kit::Choice<Floor, 2> floor{
    "floor",
    "'smooth': a plate without end; 'rough': with particles of diameter D glued onto it at random, their tops in the "
    "plane z = 0, over 45 % of the area",
    {{{"smooth", Floor::smooth}, {"rough", Floor::rough}}}};
inline constexpr kit::Real gravity{"gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)};
inline constexpr kit::Real settle_time{
    "settle_time", "s", "time the powder falls and settles in the tube before it is lifted", 0.32, {0, 1e3}};
inline constexpr kit::Real end_time{
    "end_time", "s",
    "time after the tube starts at which the case ends at the latest; it ends when the heap is at rest and the tube is "
    "above it",
    3, above(0, 1e4)};

[[nodiscard]] inline std::vector<ParameterSpec> parameters() {
    return kit::declared(tube_diameter, lift_speed, particles, floor, gravity, settle_time, end_time, powder.diameter,
                         powder.size_distribution, powder.size_spread, powder.size_file, powder.density,
                         powder.youngs_modulus, powder.poisson_ratio, powder.restitution, powder.friction,
                         powder.rolling_friction, powder.rolling_law, powder.wall_friction,
                         powder.wall_rolling_friction, powder.wall_restitution, powder.cohesion, powder.cohesion_law,
                         powder.surface_energy, powder.wall_cohesion, powder.wall_surface_energy, powder.time_step,
                         powder.time_step_fraction, powder.precision);
}

}  // namespace grainsweep::heap::question
