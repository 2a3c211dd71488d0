// Inputs of a case of powder spreading. Default values after Wu (2020); study.hpp has the geometry.
#pragma once

#include "solver/scenes/kit/powder.hpp"
#include "solver/scenes/kit/stl_wall.hpp"
#include "solver/scenes/spreading/tool.hpp"

namespace grainsweep::spreading::question {

using kit::above;
using kit::if_file;
using kit::if_set;
using kit::if_word;

inline constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.friction = p.friction.with("Coulomb friction of particles, base and tool", 0.2, {0, 2});
    p.rolling_friction = p.rolling_friction.with(
        "rolling friction of particles, base and tool: tangent of the steepest slope a particle "
        "stands on",
        0.0, {0, 1});
    return p;
}();

inline constexpr kit::ChoiceOrFile<Tool, 2> tool{
    "tool",
    "what spreads the powder: 'blade' a bar; 'roller' a cylinder across the layer, travelling and turning; or an STL "
    "file, x along the travel, y across, z up, whose lowest point passes the base at the gap: a profile, the same all "
    "along y and at least as long as the layer is wide, or a surface just as long, which repeats itself",
    {{{"blade", Tool::blade}, {"roller", Tool::roller}}},
    Tool::file,
    kit::require_stl};
inline constexpr kit::Real tool_scale = [] {
    kit::Real p = kit::stl_wall("tool", "", "tool_scale", "tool_facet_angle").scale;
    p.only = {if_file("tool")};
    return p;
}();
inline constexpr kit::Real tool_facet_angle = [] {
    kit::Real p = kit::stl_wall("tool", "", "tool_scale", "tool_facet_angle").facet_angle;
    p.only = {if_file("tool")};
    return p;
}();
inline constexpr kit::Real roller_diameter{"roller_diameter",          "m", "diameter of the roller", 0.02, {1e-5, 0.1},
                                           {if_word("tool", "roller")}};
inline constexpr kit::Real roller_spin{
    "roller_spin",
    "1",
    "speed of the roller's surface about its axis over that of its travel; above 0 counter-rotating, the underside "
    "moves along the travel; 0: a round blade; -1: it rolls over the layer",
    0.0,
    {-20, 20},
    {if_word("tool", "roller")}};
inline constexpr kit::Real gap{
    "gap",
    "m",
    "height of the tool's lowest point over the base, on a rough one over the tops of its particles",
    0.004,
    {1e-5, 0.1}};
inline constexpr kit::Real speed{"speed", "m/s", "speed of the tool", 1.4, {1e-3, 10}};
inline constexpr kit::Real gravity{"gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)};
inline constexpr kit::Real vibration_amplitude{
    "vibration_amplitude",          "m", "vertical vibration of the tool: amplitude of a sine", 0.0, {0, 0.01},
    {if_set("vibration_frequency")}};
inline constexpr kit::Real vibration_frequency{
    "vibration_frequency",          "Hz", "vertical vibration of the tool: frequency", 0.0, {0, 1e5},
    {if_set("vibration_amplitude")}};
inline constexpr kit::Real width{
    "width", "1", "period of the layer across the blade's motion, in diameters", 10, {3, 1000}};
inline constexpr kit::Real layer_area{
    "layer_area", "m2", "solid area of the layer in the plane of the motion", 400e-6, {1e-10, 0.1}};
inline constexpr kit::Real layer_beyond{"layer_beyond",
                                        "m",
                                        "length of the layer beyond the end of the travel, where the powder ahead of "
                                        "the tool ends up; short for fine powders",
                                        0.02,
                                        {1e-5, 1}};
inline constexpr kit::Whole layers{"layers",
                                   "layers spread on top of each other: after each the platform sinks by the gap, what "
                                   "lies ahead of the tool is taken "
                                   "away, and the same powder settles before the tool anew",
                                   1,
                                   {1, 1000}};
inline constexpr kit::Choice<Base, 2> base{
    "base",
    "what the first layer lies on: 'smooth' a plane; 'rough' particles of diameter D glued to it, their tops at height "
    "0; what lies in the hollows counts as spread",
    {{{"smooth", Base::smooth}, {"rough", Base::rough}}}};
inline constexpr kit::Real settle_time{
    "settle_time", "s", "time the layer settles before the tool starts, each layer anew", 0.15, {0, 100}};
inline constexpr kit::Whole bed_seed{
    "bed_seed",
    "which settled bed; 0: another one for each case and replicate; n: the n-th one, settled once for all cases "
    "of the same powder and time step, whatever gap, speed and tool, and kept beside the database. Cases then "
    "differ by where the tool starts, up to one diameter before the layer, and share what is particular to the "
    "bed, 8 to 31 % of the variance of mfr between seeds and a third of packing_fraction's: replicates "
    "underestimate the error by so much, and comparisons over one bed are more precise by as much",
    0,
    {0, 9.0e15},
    {if_set("settle_time")}};
inline constexpr kit::Real travel{
    "travel",
    "m",
    "travel of the tool; the flux counts from 2/7 of it, and the layer is layer_beyond longer",
    0.07,
    {1e-5, 1}};
inline constexpr kit::Real blade_thickness{"blade_thickness",         "m", "thickness of the blade", 0.005, {1e-6, 0.1},
                                           {if_word("tool", "blade")}};
inline constexpr kit::Real blade_edge_radius{
    "blade_edge_radius",       "m", "radius of the blade's lower edges; 0: sharp", 0.0, {0, 0.05},
    {if_word("tool", "blade")}};
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
    return kit::declared(powder.friction, powder.rolling_friction, powder.rolling_law, powder.tangential_limit,
                         powder.restitution, powder.diameter, powder.size_distribution, powder.size_spread,
                         powder.size_file, tool, tool_scale, tool_facet_angle, roller_diameter, roller_spin, gap, speed,
                         powder.cohesion, powder.cohesion_law, powder.surface_energy, powder.youngs_modulus,
                         powder.poisson_ratio, powder.density, gravity, vibration_amplitude, vibration_frequency, width,
                         layer_area, layer_beyond, layers, base, settle_time, bed_seed, travel, blade_thickness,
                         blade_edge_radius, powder.time_step, powder.time_step_fraction, standard_error,
                         powder.precision);
}

}  // namespace grainsweep::spreading::question
