// What a case of the hopper is asked. study.hpp has the geometry.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::hopper::question {

using kit::above;
using kit::if_word;

/// Glass-like beads of 5 mm, softened.
inline constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.diameter = p.diameter.with(0.005, {1e-6, 0.1});
    p.density = p.density.with(2500, {100, 25000});
    p.youngs_modulus = p.youngs_modulus.with(5e6, {1e5, 1e12});
    p.friction = p.friction.with(0.5, {0, 2});
    return p;
}();

enum class Floor { flat, conical };
inline constexpr kit::Choice<Floor, 2> shape{
    "shape",
    "'flat': a thin floor with a sharp-edged opening; 'conical': a cone from the opening up to the container",
    {{{"flat", Floor::flat}, {"conical", Floor::conical}}}};
inline constexpr kit::Real half_angle{"half_angle", "deg",   "angle of the cone's wall to the vertical",
                                      30,           {5, 85}, {if_word("shape", "conical")}};
inline constexpr kit::Real container_diameter{
    "container_diameter", "m", "inner diameter of the container; of one with a slot its width", 0.08, {1e-4, 10}};
enum class Opening { round, slot };
inline constexpr kit::Choice<Opening, 2> opening{
    "opening",
    "'round', in a cylinder; 'slot', in a box with a flat floor that repeats itself along the slot",
    {{{"round", Opening::round}, {"slot", Opening::slot}}}};
inline constexpr kit::Real opening_size{
    "opening_size", "m", "diameter of a round opening, width of a slot", 0.035, {1e-6, 10}};
inline constexpr kit::Real slot_length{"slot_length", "m",        "period along the slot",
                                       0.03,          {1e-6, 10}, {if_word("opening", "slot")}};
inline constexpr kit::Whole particles{"particles", "number of particles", 4000, {1, 5e6}};
inline constexpr kit::Real gravity{"gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)};
inline constexpr kit::Real settle_time{
    "settle_time", "s", "time the powder falls and settles on the closed opening", 0.4, {0, 1e3}};
inline constexpr kit::Real end_time{"end_time", "s", "time after the opening at which the case ends at the latest", 6,
                                    above(0, 1e4)};
inline constexpr kit::Real stop_share{"stop_share", "1",
                                      "share of the mass outside at which the case ends; 1: not before the flow ceases",
                                      1, above(0, 1)};
inline constexpr kit::Real frame_interval{
    "frame_interval", "s", "time between values of mass_series, to the next time step", 0.02, above(0, 100)};

[[nodiscard]] inline std::vector<ParameterSpec> parameters() {
    return kit::declared(shape, half_angle, container_diameter, opening, opening_size, slot_length, particles, gravity,
                         settle_time, end_time, stop_share, frame_interval, powder.diameter, powder.size_distribution,
                         powder.size_spread, powder.size_file, powder.density, powder.youngs_modulus,
                         powder.poisson_ratio, powder.restitution, powder.friction, powder.rolling_friction,
                         powder.rolling_law, powder.wall_friction, powder.wall_rolling_friction,
                         powder.wall_restitution, powder.cohesion, powder.cohesion_law, powder.surface_energy,
                         powder.wall_cohesion, powder.wall_surface_energy, powder.time_step, powder.time_step_fraction,
                         powder.precision);
}

}  // namespace grainsweep::hopper::question
