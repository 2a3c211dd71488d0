#include "solver/scenes/tpms/question.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/shaking.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/particles/packing.hpp"
#include "solver/scenes/kit/powder.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace grainsweep {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

namespace ask {

using geometry::TpmsCell;
using kit::above;
using kit::if_set;
using kit::if_word;

constexpr kit::Powder powder = [] {
    kit::Powder p;
    p.diameter = p.diameter.with("particle diameter", 45e-6, {1e-7, 0.1});
    p.friction = p.friction.with("Coulomb friction between particles, and with the wall", 0.5, {0, 2});
    p.rolling_friction = p.rolling_friction.with(
        "rolling friction between particles, and with the wall: tangent of the steepest slope a particle stands on", 0,
        {0, 1});
    p.restitution = p.restitution.with("coefficient of restitution", 0.64, {0.01, 1});
    p.cohesion = p.cohesion.with("cohesion energy density k_c", 0, {0, 1e7});
    p.youngs_modulus = p.youngs_modulus.with("Young's modulus of particles and wall", 2.11e6, {1e4, 1e12});
    p.poisson_ratio = p.poisson_ratio.with("Poisson's ratio", 0.3, {0, 0.5});
    p.density = p.density.with("density of the particle material", 7980, {1, 3e4});
    p.time_step = p.time_step.with("time step", 1e-6, {0, unbounded, true, true});
    p.wall_friction =
        p.wall_friction.with("Coulomb friction at the wall; -1: friction", kit::as_powder, {kit::as_powder, 2});
    p.wall_rolling_friction = p.wall_rolling_friction.with("rolling friction at the wall; -1: rolling_friction",
                                                           kit::as_powder, {kit::as_powder, 1});
    p.wall_restitution =
        p.wall_restitution.with("restitution at the wall; -1: restitution", kit::as_powder, {kit::as_powder, 1});
    p.wall_cohesion = p.wall_cohesion.with("cohesion energy density at the wall; -1: cohesion", kit::as_powder,
                                           {kit::as_powder, 1e7});
    p.wall_surface_energy = p.wall_surface_energy.with("work of adhesion at the wall; -1: surface_energy",
                                                       kit::as_powder, {kit::as_powder, 10});
    p.precision = p.precision.with("arithmetic of the contact forces");
    return p;
}();

constexpr auto cells = [] {
    std::array<kit::Named<TpmsCell>, geometry::tpms_cells.size()> named{};
    for (std::size_t k = 0; k < named.size(); ++k)
        named[k] = {geometry::tpms_cells[k].name, geometry::tpms_cells[k].cell};
    return named;
}();

constexpr kit::Choice<TpmsCell, cells.size()> cell{"cell", "triply periodic minimal surface of the cell", cells};
constexpr kit::Whole side{
    "side", "side of the surface that holds the powder, the sign of its level set (0: the study's)", 0, {-1, 1}};
constexpr kit::Real edge{"edge", "particle diameters", "edge of the cubic cell, L", 100, {8, 200}};
constexpr kit::Real shell{"shell", "particle diameters", "largest thickness of the frozen shell", 4, {0.5, 20}};
constexpr kit::FileOr packing{
    "packing", "random close packing made for the case, or a CSV file of centres (x,y,z in diameters)", "generated",
    [](std::string_view csv) { (void)particles::read_packing(csv, unbounded); }};  // whatever the edge
constexpr kit::Real packing_fraction{"packing_fraction",
                                     "1",
                                     "volume fraction of the generated packing",
                                     0.62,
                                     {0.05, 0.635},
                                     {if_word("packing", "generated")}};
constexpr kit::Whole packing_seed{"packing_seed",
                                  "which generated packing; 0: another one for each case and replicate",
                                  1,
                                  {0, 9.0e15},
                                  {if_word("packing", "generated")}};
constexpr kit::Choice<dem::FrictionLimit, 2> friction_limit{
    "friction_limit",
    "what limits friction: the contact force without cohesion ('jkr': the net one plus twice the pull-off force), or "
    "the "
    "net normal force",
    {{{"contact", dem::FrictionLimit::contact}, {"net", dem::FrictionLimit::net}}},
    {if_set("friction")}};
constexpr kit::Real gravity{"gravity", "m/s2", "acceleration of free fall", 9.81, above(0, 1e5)};
constexpr kit::Real tilt{"tilt", "deg", "angle between gravity and -z", 0, {0, 180}};
constexpr kit::Real tilt_azimuth{
    "tilt_azimuth", "deg", "direction into which gravity is tilted, from x to y", 0, {0, 360}, {if_set("tilt")}};
constexpr kit::Real vibration_amplitude{
    "vibration_amplitude",          "m", "vibration of the whole cell: amplitude of a sine", 0, {0, 0.01},
    {if_set("vibration_frequency")}};
constexpr kit::Real vibration_frequency{
    "vibration_frequency",          "Hz", "vibration of the whole cell: frequency", 0, {0, 1e6},
    {if_set("vibration_amplitude")}};
constexpr kit::Choice<std::size_t, 3> vibration_direction{
    "vibration_direction",
    "axis along which the cell vibrates",
    {{{"z", 2}, {"x", 0}, {"y", 1}}},
    {if_set("vibration_amplitude"), if_set("vibration_frequency")}};
constexpr kit::Real end_time{"end_time", "sqrt(2 L/g)", "time after which the case ends", 10, above(0, 1000)};
constexpr kit::Choice<bool, 2> ends_when_quiet{
    "settle_rule",
    "quiet: end early when for 1.5 sqrt(2 L/g), and two periods of vibration, at most a thousandth "
    "of the powder in the cell (or one particle) was faster than 0.001 sqrt(2 g L), and as much left it: the "
    "relative error of the retention; none: go on to the end time",
    {{{"quiet", true}, {"none", false}}}};
constexpr kit::Real rest_speed{
    "rest_speed",
    "sqrt(2 g L)",
    "powder slower than this for 256 time steps, with nothing faster near and no net force of half its weight, "
    "is not advanced; 0: all is. At 0.001 the retention errs by less than 0.005, a jammed cell costs 1/1.4. "
    "Not in a cell that vibrates, which never rests",
    0,
    {0, 0.01},
    {if_word("precision", "mixed")}};

}  // namespace ask

dem::Material material_of(const Inputs& inputs) {
    dem::Material material = ask::powder.material(inputs);
    material.friction_limit = ask::friction_limit(inputs);
    return material;
}

}  // namespace

std::vector<ParameterSpec> tpms_discharge_parameters() {
    using namespace ask;
    return kit::declared(
        cell, side, edge, shell, packing, packing_fraction, packing_seed, powder.diameter, powder.friction,
        powder.rolling_friction, powder.rolling_law, friction_limit, powder.tangential_limit, powder.restitution,
        powder.cohesion, powder.cohesion_law, powder.surface_energy, powder.wall_friction, powder.wall_rolling_friction,
        powder.wall_restitution, powder.wall_cohesion, powder.wall_surface_energy, powder.youngs_modulus,
        powder.poisson_ratio, powder.density, gravity, tilt, tilt_azimuth, vibration_amplitude, vibration_frequency,
        vibration_direction, end_time, ends_when_quiet, powder.time_step, powder.precision, rest_speed);
}

const std::string& tpms_packing_text(const Inputs& inputs, const Files& files) {
    return ask::packing.contents(inputs, files);
}

TpmsQuestion::TpmsQuestion(const Inputs& inputs, std::uint64_t seed)
    : cell(ask::cell(inputs)),
      side(static_cast<int>(ask::side(inputs))),
      edge(ask::edge(inputs)),
      shell(ask::shell(inputs)),
      packing_given(ask::packing(inputs)),
      packing_fraction(ask::packing_fraction(inputs)),
      packing_seed(static_cast<std::uint64_t>(ask::packing_seed(inputs))),
      diameter(ask::powder.diameter(inputs)),
      material(material_of(inputs)),
      wall(ask::powder.wall_surface(inputs)),
      gravity(ask::gravity(inputs)),
      end_time(ask::end_time(inputs)),
      stop_when_quiet(ask::ends_when_quiet(inputs)),
      time_step(ask::powder.time_step(inputs)),
      rest_speed(ask::rest_speed(inputs)),
      precision(ask::powder.precision(inputs)) {
    if (side == 0) side = geometry::traits(cell).kept_side;
    if (packing_seed == 0) packing_seed = seed;
    if (shell >= edge / 2) throw std::invalid_argument("shell must be thinner than half the edge of the cell");
    const double tilt = ask::tilt(inputs) * std::numbers::pi / 180;
    const double azimuth = ask::tilt_azimuth(inputs) * std::numbers::pi / 180;
    if (tilt != 0) down = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt)};
    shaking.frequency = ask::vibration_frequency(inputs);
    shaking.amplitude[ask::vibration_direction(inputs)] = ask::vibration_amplitude(inputs);
    if (shaking.frequency * time_step > 0.05) {
        char sentence[160];
        std::snprintf(sentence, sizeof sentence,
                      "vibration_frequency is %.4g Hz: its period must last at least twenty time steps of %.3g s",
                      shaking.frequency, time_step);
        throw std::invalid_argument(sentence);
    }
    if (rest_speed > 0 && !dem::is_still(shaking))
        throw std::invalid_argument("powder in a cell that vibrates never rests: rest_speed must be 0");
    const double rayleigh = dem::rayleigh_time(material, diameter / 2);
    if (time_step > rayleigh) {
        char sentence[160];
        std::snprintf(
            sentence, sizeof sentence,
            "time_step is %.3g s, but a wave crosses a particle in %.3g s (Rayleigh time): take a fraction of it",
            time_step, rayleigh);
        throw std::invalid_argument(sentence);
    }
}

double TpmsQuestion::free_fall_time() const {
    return std::sqrt(2 * length() / gravity);
}
double TpmsQuestion::free_fall_speed() const {
    return std::sqrt(2 * length() * gravity);
}
double TpmsQuestion::standard_weight() const {
    return dem::sphere_mass(diameter / 2, material.density) * 9.81;
}

}  // namespace grainsweep
