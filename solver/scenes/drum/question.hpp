// What a case of the rotating drum is asked. study.hpp has the geometry.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::drum::question {

using kit::above;
using kit::if_set;
using kit::if_word;
using kit::if_zero;

/// Glass-like beads of 5 mm, softened.
inline constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.diameter = p.diameter.with(0.005, {1e-6, 0.1});
    p.density = p.density.with(2500, {100, 25000});
    p.youngs_modulus = p.youngs_modulus.with(5e6, {1e5, 1e12});
    p.friction = p.friction.with(0.5, {0, 2});
    p.rolling_friction = p.rolling_friction.with(0.1, {0, 1});
    p.wall_friction =
        p.wall_friction.with("Coulomb friction at the drum; -1: friction", kit::as_powder, {kit::as_powder, 2});
    return p;
}();

inline constexpr kit::Real drum_diameter{"drum_diameter", "m", "inner diameter of the drum", 0.15, {1e-4, 10}};
inline constexpr kit::Real length{"length", "m", "length of the drum along its axis", 0.03, {1e-5, 10}};

enum class Ends { periodic, plates };
inline constexpr kit::Choice<Ends, 2> ends{
    "ends",
    "'periodic': a slice of a long drum, without ends; 'plates': flat ends that turn with the drum",
    {{{"periodic", Ends::periodic}, {"plates", Ends::plates}}}};
inline constexpr kit::Real end_friction{"end_friction",
                                        "1",
                                        "Coulomb friction at the end plates; -1: that of the drum",
                                        kit::as_powder,
                                        {kit::as_powder, 2},
                                        {if_word("ends", "plates")}};
inline constexpr kit::Whole particles{"particles", "number of particles; 0: from fill", 0, {0, 5e6}};
inline constexpr kit::Real fill{
    "fill", "1",           "volume of the powder at a solid fraction of 0.58 over that of the drum",
    0.35,   above(0, 0.6), {if_zero("particles")}};
inline constexpr kit::Real rpm{"rpm", "1/min", "speed of the drum, revolutions per minute", 25, above(0, 6000)};
inline constexpr kit::Real gravity{"gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)};
inline constexpr kit::Real turning_time{
    "turning_time", "s", "time the drum turns, from the loose filling on, before anything is measured", 1.3, {0, 1e4}};
inline constexpr kit::Real measured_time{"measured_time", "s", "time over which frames are taken and averaged", 1.8,
                                         above(0, 1e4)};
inline constexpr kit::Real frame_interval{"frame_interval", "s", "time from frame to frame, to the next time step",
                                          0.02, above(0, 100)};
inline constexpr kit::Real occupancy_cell{
    "occupancy_cell", "m", "side of the cells of occupancy and surface; 0: D", 0, {0, 1}};

[[nodiscard]] inline std::vector<ParameterSpec> parameters() {
    return kit::declared(
        drum_diameter, length, ends, end_friction, particles, fill, rpm, gravity, turning_time, measured_time,
        frame_interval, occupancy_cell, powder.diameter, powder.size_distribution, powder.size_spread, powder.size_file,
        powder.density, powder.youngs_modulus, powder.poisson_ratio, powder.restitution, powder.friction,
        powder.rolling_friction, powder.rolling_law, powder.wall_friction, powder.wall_rolling_friction,
        powder.wall_restitution, powder.cohesion, powder.cohesion_law, powder.surface_energy, powder.wall_cohesion,
        powder.wall_surface_energy, powder.time_step, powder.time_step_fraction, powder.precision);
}

}  // namespace grainsweep::drum::question
