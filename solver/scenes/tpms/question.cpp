#include "solver/scenes/tpms/question.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/shaking.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/particles/packing.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

namespace grainsweep {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

ParameterSpec number(std::string name, std::string unit, std::string meaning, double standard, Interval interval,
                     std::vector<Relevance> relevant_if = {}) {
    return {std::move(name), std::move(unit), std::move(meaning), standard, interval, std::move(relevant_if)};
}

ParameterSpec whole(std::string name, std::string meaning, std::int64_t standard, Interval interval,
                    std::vector<Relevance> relevant_if = {}) {
    return {std::move(name), "1", std::move(meaning), standard, interval, std::move(relevant_if)};
}

/// A parameter whose value is one of some words; the first is the default. check_file: it may be a file as well.
ParameterSpec word(std::string name, std::string meaning, std::vector<std::string> allowed,
                   std::vector<Relevance> relevant_if = {},
                   std::function<void(std::string_view contents)> check_file = {}) {
    std::string standard = allowed.front();
    const bool file_allowed = check_file != nullptr;
    return {std::move(name),
            "",
            std::move(meaning),
            std::move(standard),
            Words{std::move(allowed), file_allowed, std::move(check_file)},
            std::move(relevant_if)};
}

Relevance nonzero(std::string other) {
    return {std::move(other), Relevance::Condition::nonzero, {}};
}

std::vector<ParameterSpec> powder_parameters() {
    return {
        number("diameter", "m", "particle diameter", 45e-6, {1e-7, 0.1}),
        number("friction", "1", "Coulomb friction between particles, and with the wall", 0.5, {0, 2}),
        word("friction_limit", "what limits friction: the contact force without cohesion, or the net normal force",
             {"contact", "net"}, {nonzero("friction"), nonzero("cohesion")}),
        number("restitution", "1", "coefficient of restitution", 0.64, {0.01, 1}),
        number("cohesion", "J/m3", "cohesion energy density k_c", 0, {0, 1e7}),
        word("cohesion_law", "area on which the cohesion energy density acts", {"sjkr", "sjkr2", "paper"},
             {nonzero("cohesion")}),
        number("youngs_modulus", "Pa", "Young's modulus of particles and wall", 2.11e6, {1e4, 1e12}),
        number("poisson_ratio", "1", "Poisson's ratio", 0.3, {0, 0.5}),
        number("density", "kg/m3", "density of the particle material", 7980, {1, 3e4}),
    };
}

double real(const Inputs& inputs, std::string_view name) {
    return std::get<double>(inputs.find(name)->second);
}
std::int64_t count(const Inputs& inputs, std::string_view name) {
    return std::get<std::int64_t>(inputs.find(name)->second);
}
const std::string& text(const Inputs& inputs, std::string_view name) {
    return std::get<std::string>(inputs.find(name)->second);
}

dem::Material material_of(const Inputs& inputs) {
    static const std::map<std::string, dem::CohesionArea, std::less<>> areas = {
        {"sjkr", dem::CohesionArea::sjkr}, {"sjkr2", dem::CohesionArea::sjkr2}, {"paper", dem::CohesionArea::paper}};
    dem::Material material;
    material.youngs_modulus = real(inputs, "youngs_modulus");
    material.poisson_ratio = real(inputs, "poisson_ratio");
    material.density = real(inputs, "density");
    material.restitution = real(inputs, "restitution");
    material.friction = real(inputs, "friction");
    material.cohesion = real(inputs, "cohesion");
    material.cohesion_area = areas.at(text(inputs, "cohesion_law"));
    material.friction_limit =
        text(inputs, "friction_limit") == "net" ? dem::FrictionLimit::net : dem::FrictionLimit::contact;
    return material;
}

}  // namespace

std::vector<ParameterSpec> tpms_discharge_parameters() {
    const Relevance generated{"packing", Relevance::Condition::is_word, {"generated"}};
    std::vector<std::string> cells;
    for (const auto& known : geometry::tpms_cells) cells.emplace_back(known.name);

    std::vector<ParameterSpec> parameters = {
        word("cell", "triply periodic minimal surface of the cell", cells),
        whole("side", "side of the surface that holds the powder, the sign of its level set (0: the study's)", 0,
              {-1, 1}),
        number("edge", "particle diameters", "edge of the cubic cell, L", 100, {8, 200}),
        number("shell", "particle diameters", "largest thickness of the frozen shell", 4, {0.5, 20}),
        word("packing", "random close packing made for the case, or a CSV file of centres (x,y,z in diameters)",
             {"generated"}, {},
             [](std::string_view csv) {
                 (void)particles::read_packing(csv, std::numeric_limits<double>::infinity());  // whatever the edge
             }),
        number("packing_fraction", "1", "volume fraction of the generated packing", 0.62, {0.05, 0.635}, {generated}),
        whole("packing_seed", "which generated packing; 0: another one for each case and replicate", 1, {0, 9.0e15},
              {generated}),
    };
    for (auto& parameter : powder_parameters()) parameters.push_back(std::move(parameter));
    parameters.push_back(number("gravity", "m/s2", "acceleration of free fall", 9.81, {0, 1e5, true, false}));
    parameters.push_back(number("tilt", "deg", "angle between gravity and -z", 0, {0, 180}));
    parameters.push_back(number("tilt_azimuth", "deg", "direction into which gravity is tilted, from x to y", 0,
                                {0, 360}, {nonzero("tilt")}));
    parameters.push_back(number("vibration_amplitude", "m", "vibration of the whole cell: amplitude of a sine", 0,
                                {0, 0.01}, {nonzero("vibration_frequency")}));
    parameters.push_back(number("vibration_frequency", "Hz", "vibration of the whole cell: frequency", 0, {0, 1e6},
                                {nonzero("vibration_amplitude")}));
    parameters.push_back(word("vibration_direction", "axis along which the cell vibrates", {"z", "x", "y"},
                              {nonzero("vibration_amplitude"), nonzero("vibration_frequency")}));
    parameters.push_back(
        number("end_time", "sqrt(2 L/g)", "time after which the case ends", 10, {0, 1000, true, false}));
    parameters.push_back(
        word("settle_rule",
             "quiet: end early when for 1.5 sqrt(2 L/g), and two periods of vibration, at most a thousandth "
             "of the powder in the cell (or one particle) was faster than 0.001 sqrt(2 g L), and as much left it: the "
             "relative error of the retention; none: go on to the end time",
             {"quiet", "none"}));
    parameters.push_back(number("time_step", "s", "time step", 1e-6, {0, unbounded, true, true}));
    parameters.push_back(word("precision", "arithmetic of the contact forces", {"mixed", "double"}));
    parameters.push_back(number(
        "rest_speed", "sqrt(2 g L)",
        "powder slower than this for 256 time steps, with nothing faster near and no net force of half its weight, "
        "is not advanced; 0: all is. At 0.001 the retention errs by less than 0.005, a jammed cell costs 1/1.4. "
        "Not in a cell that vibrates, which never rests",
        0, {0, 0.01}, {{"precision", Relevance::Condition::is_word, {"mixed"}}}));
    return parameters;
}

std::vector<ObservableSpec> tpms_discharge_observables() {
    const std::string time = "time (sqrt(2 L/g))";
    return {
        {"retention", "1", "mobile centres in the cell at the end over those at the start", Shape::scalar},
        {"time_to_half", "sqrt(2 L/g)", "when half has left; undefined if it never does", Shape::scalar},
        {"time_to_tenth", "sqrt(2 L/g)", "when a tenth is left; undefined if it never is", Shape::scalar},
        {"discharge_rate", "1/sqrt(2 L/g)",
         "share of the powder that leaves per sqrt(2 L/g) while the second quarter leaves; undefined if half never "
         "does",
         Shape::scalar},
        {"beverloo_rate", "1/sqrt(2 L/g)",
         "the same by Beverloo's law for the outlet and the packing's density; undefined in a tilted cell",
         Shape::scalar},
        {"outlet_diameter", "particle diameters",
         "largest round opening in the lower face between the surfaces of wall particles", Shape::scalar},
        {"peak_velocity", "sqrt(2 g L)",
         "largest speed along gravity in the cell, at any sample; 0: nothing moved along it", Shape::scalar},
        {"max_overlap", "particle diameters", "largest overlap after any step; 0: nothing touched", Shape::scalar},
        {"max_force", "m 9.81 m/s2", "largest contact force, at any sample; 0: nothing touched", Shape::scalar},
        {"particles", "1", "mobile particles at the start", Shape::scalar},
        {"wall_particles", "1", "frozen particles of the shell", Shape::scalar},
        {"retention_series", "1", "retention every 0.0165 sqrt(2 L/g)", Shape::series, time},
        {"velocity_series", "sqrt(2 g L)", "largest speed along gravity in the cell; undefined while it is empty",
         Shape::series, time},
        {"mobile_series", "1", "mobile particles not yet gone (two diameters outside the cell) over those at the start",
         Shape::series, time},
        {"at_rest_series", "1", "those in the cell slower than 0.001 sqrt(2 g L) over those at the start",
         Shape::series, time},
        {"overlap_histogram", "1",
         "share of contacts per bin of overlap, twenty bins per decade, every 0.165 sqrt(2 L/g); below 1e-6: the "
         "first; none "
         "where nothing touches",
         Shape::profile, "overlap (particle diameters)"},
        {"force_histogram", "1",
         "share of contacts per bin of force, twenty bins per decade, every 0.165 sqrt(2 L/g); below 1e-3: the first; "
         "none "
         "where nothing touches",
         Shape::profile, "force (m 9.81 m/s2)"},
        {"retained_profile", "1", "retention of those of twenty layers along z that held powder; bin: z/L",
         Shape::profile, "z/L"},
    };
}

TpmsQuestion::TpmsQuestion(const Inputs& inputs, std::uint64_t seed)
    : cell(geometry::tpms_cell_named(text(inputs, "cell")).value()),
      side(static_cast<int>(count(inputs, "side"))),
      edge(real(inputs, "edge")),
      shell(real(inputs, "shell")),
      packing(text(inputs, "packing")),
      packing_fraction(real(inputs, "packing_fraction")),
      packing_seed(static_cast<std::uint64_t>(count(inputs, "packing_seed"))),
      diameter(real(inputs, "diameter")),
      material(material_of(inputs)),
      gravity(real(inputs, "gravity")),
      end_time(real(inputs, "end_time")),
      stop_when_quiet(text(inputs, "settle_rule") == "quiet"),
      time_step(real(inputs, "time_step")),
      rest_speed(real(inputs, "rest_speed")),
      precision(text(inputs, "precision") == "double" ? dem::Method::Precision::double_precision
                                                      : dem::Method::Precision::mixed) {
    if (side == 0) side = geometry::traits(cell).kept_side;
    if (packing_seed == 0) packing_seed = seed;
    if (shell >= edge / 2) throw std::invalid_argument("shell must be thinner than half the edge of the cell");
    const double tilt = real(inputs, "tilt") * std::numbers::pi / 180;
    const double azimuth = real(inputs, "tilt_azimuth") * std::numbers::pi / 180;
    if (tilt != 0) down = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt)};
    const std::map<std::string, std::size_t, std::less<>> axes = {{"x", 0}, {"y", 1}, {"z", 2}};
    shaking.frequency = real(inputs, "vibration_frequency");
    shaking.amplitude[axes.at(text(inputs, "vibration_direction"))] = real(inputs, "vibration_amplitude");
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
