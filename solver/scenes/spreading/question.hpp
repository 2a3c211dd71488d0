// What a case of powder spreading is asked. Default values after Wu (2020); study.hpp has the geometry.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::spreading::question {

using kit::above;
using kit::if_set;

inline constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.friction = p.friction.with("Coulomb friction of particles, base and blade", 0.2, {0, 2});
    p.rolling_friction = p.rolling_friction.with(
        "rolling friction of particles, base and blade: tangent of the steepest slope a particle "
        "stands on",
        0.0, {0, 1});
    return p;
}();

inline constexpr kit::Real gap{"gap", "m", "height of the blade's lower edge over the base", 0.004, {1e-5, 0.1}};
inline constexpr kit::Real speed{"speed", "m/s", "speed of the blade", 1.4, {1e-3, 10}};
inline constexpr kit::Real gravity{"gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)};
inline constexpr kit::Real vibration_amplitude{
    "vibration_amplitude",          "m", "vertical vibration of the blade: amplitude of a sine", 0.0, {0, 0.01},
    {if_set("vibration_frequency")}};
inline constexpr kit::Real vibration_frequency{
    "vibration_frequency",          "Hz", "vertical vibration of the blade: frequency", 0.0, {0, 1e5},
    {if_set("vibration_amplitude")}};
inline constexpr kit::Real width{
    "width", "1", "period of the layer across the blade's motion, in diameters", 10, {3, 1000}};
inline constexpr kit::Real layer_area{
    "layer_area", "m2", "solid area of the layer in the plane of the motion", 400e-6, {1e-6, 0.1}};
inline constexpr kit::Real settle_time{
    "settle_time", "s", "time the layer settles before the blade starts", 0.15, {0, 100}};
inline constexpr kit::Whole bed_seed{
    "bed_seed",
    "which settled bed; 0: another one for each case and replicate; n: the n-th one, settled once for all cases "
    "of the same powder and time step, whatever gap, speed and blade, and kept beside the database. Cases then "
    "differ by where the blade starts, up to one diameter before the layer, and share what is particular to the "
    "bed, 8 to 31 % of the variance of mfr between seeds and a third of packing_fraction's: replicates "
    "underestimate the error by so much, and comparisons over one bed are more precise by as much",
    0,
    {0, 9.0e15},
    {if_set("settle_time")}};
inline constexpr kit::Real travel{"travel",
                                  "m",
                                  "travel of the blade; the flux counts from 2/7 of it, and the layer is 20 mm longer",
                                  0.07,
                                  {1e-3, 1}};
inline constexpr kit::Real blade_thickness{"blade_thickness", "m", "thickness of the blade", 0.005, {1e-4, 0.1}};
inline constexpr kit::Real blade_edge_radius{
    "blade_edge_radius", "m", "radius of the blade's lower edges; 0: sharp", 0.0, {0, 0.05}};
inline constexpr kit::Real standard_error{
    "standard_error",
    "1",
    "ends the sweep once mfr_standard_error is below this, or nothing has passed, looked at every tenth of "
    "the measured travel from its half on; 0: sweeps to the end. The flux falls by 5 to 8 % over the "
    "measured travel, so "
    "a shorter sweep answers up to 4 % higher: compare only cases asked alike",
    0.0,
    {0, 1}};

[[nodiscard]] inline std::vector<ParameterSpec> parameters() {
    return kit::declared(powder.friction, powder.rolling_friction, powder.rolling_law, powder.restitution,
                         powder.diameter, powder.size_distribution, powder.size_spread, powder.size_file, gap, speed,
                         powder.cohesion, powder.cohesion_law, powder.surface_energy, powder.youngs_modulus,
                         powder.poisson_ratio, powder.density, gravity, vibration_amplitude, vibration_frequency, width,
                         layer_area, settle_time, bed_seed, travel, blade_thickness, blade_edge_radius,
                         powder.time_step, powder.time_step_fraction, standard_error, powder.precision);
}

}  // namespace grainsweep::spreading::question
