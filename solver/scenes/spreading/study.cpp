#include "solver/scenes/spreading/study.hpp"

#include "solver/dem/material.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "solver/scenes/scene.hpp"
#include "solver/scenes/spreading/filling.hpp"
#include "solver/scenes/spreading/question.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace grainsweep::spreading {
namespace {

using kit::require;
using kit::sentence;

constexpr double most_particles = 5e6;
constexpr double most_steps = 1e10;
constexpr double at_rest = 5;  // diameters behind a roller's axis or a surface's rear

/// Largest expected impact speed: particles thrown ahead by the tool fall back on it; all fall once at the start.
double fastest_impact(const Study& s) {
    const double shaking = 2 * std::numbers::pi * s.vibration_frequency * s.vibration_amplitude;
    const double fastest_point = s.speed * (1 + std::abs(s.roller_spin));
    return std::max(2 * std::hypot(fastest_point, shaking),
                    start_velocity + std::sqrt(2 * s.gravity * start_height(s)));
}

void lay_out(Study& s) {
    const double volume = particles::sphere_volume(s.diameter) * s.sizes.moment(3);
    const double wanted = std::round(s.layer_area * s.width / volume);
    require(wanted >= 1,
            sentence("layer_area of %.4g m2 holds no particle of diameter %.4g m", s.layer_area, s.diameter));
    require(
        wanted <= most_particles,
        sentence("layer_area and width ask for %.4g particles; at most %.4g can be simulated: make the layer or the "
                 "width smaller or the diameter larger",
                 wanted, most_particles));
    s.particles = std::llround(wanted);
    s.lattice_x = static_cast<std::int64_t>((layer_length(s) - 2 * jitter * s.diameter) / (spacing * s.diameter));
    s.lattice_y = static_cast<std::int64_t>(s.width / (spacing * s.diameter));
    require(s.lattice_x >= 1 && layer_length(s) >= 2 * s.sizes.largest() * s.diameter,
            sentence("a layer of %.4g m cannot hold particles of diameter %.4g m: make travel longer", layer_length(s),
                     s.diameter));
    require(
        2 * s.sizes.largest() * s.diameter <= s.width,
        sentence("the largest particles, %.4g diameters, are wider than half the width of %.4g diameters: make width "
                 "larger",
                 s.sizes.largest(), s.width / s.diameter));
    require(start_height(s) < domain_top, sentence("the layer would start %.4g m high, above the top of the domain at "
                                                   "%.4g m: make layer_area smaller",
                                                   start_height(s), domain_top));
}

/// Where its planes are.
void set_up_tool(Study& s, const Inputs& in, const Files& files) {
    namespace ask = question;
    s.tool = ask::tool(in);
    switch (s.tool) {
        case Tool::blade:
            s.blade_thickness = ask::blade_thickness(in);
            s.blade_edge_radius = ask::blade_edge_radius(in);
            s.behind = s.clearance = s.blade_thickness;
            require(2 * s.blade_edge_radius <= s.blade_thickness,
                    sentence("blade_edge_radius of %.4g m exceeds half the blade_thickness of %.4g m",
                             s.blade_edge_radius, s.blade_thickness));
            break;
        case Tool::roller:
            s.roller_diameter = ask::roller_diameter(in);
            s.roller_spin = ask::roller_spin(in);
            s.ahead = s.roller_diameter / 2;
            s.clearance = at_rest * s.diameter;
            break;
        case Tool::file:
            s.clearance = at_rest * s.diameter;
            s.surface =
                tool_surface(ask::tool.contents(in, files), ask::tool_scale(in), ask::tool_facet_angle(in), s.width);
            s.ahead = s.surface.high()[0];
            s.behind = -s.surface.low()[0];
            break;
    }
}

void require_layers(const Study& s) {
    if (s.layers == 1) return;
    require(s.standard_error == 0,
            "standard_error ends a sweep before its end, and the next layer needs the whole one: leave it 0 with "
            "several layers");
    const double platform = s.end_of_platform() - s.start_of_platform();
    require(platform >= 10 * s.sizes.largest() * s.diameter,
            sentence("the tool spreads a platform of %.4g m only, less than ten of the largest particles: make travel "
                     "longer than it by the %.4g m from the tool's foremost point to its edge",
                     platform, s.ahead));
    require(s.level(s.layers) <= 1,
            sentence("layers and gap pile up %.4g m; at most 1 m can be simulated", s.level(s.layers)));
}

/// Every input but those without effect before the tool starts; the time step, which may follow from some of
/// them, as it is. Inputs with which beds were always settled are left out.
std::string key_of_bed(const Inputs& inputs, const Study& s) {
    static const std::set<std::string, std::less<>> without_effect = {"gap",
                                                                      "speed",
                                                                      "vibration_amplitude",
                                                                      "vibration_frequency",
                                                                      "blade_thickness",
                                                                      "blade_edge_radius",
                                                                      "time_step",
                                                                      "time_step_fraction",
                                                                      "tool",
                                                                      "tool_scale",
                                                                      "tool_facet_angle",
                                                                      "roller_diameter",
                                                                      "roller_spin",
                                                                      "layers",
                                                                      "standard_error"};
    std::string key = "powder_spreading: settled bed\nrevision=" + std::to_string(revision) +
                      "\npath=" + std::string(instruction_path()) +
                      sentence("\ntime step=%.17g\nshare=%.17g\nsteps=%.17g\n", s.time_step, s.step_share.value_or(0),
                               static_cast<double>(s.settle_steps));
    for (const auto& [name, value] : inputs) {
        if (without_effect.contains(name)) continue;
        if (name == question::base.name && s.base == Base::smooth) continue;
        if (name == question::layer_beyond.name && s.layer_beyond == question::layer_beyond.standard) continue;
        key += name + "=";
        if (const auto* word = std::get_if<std::string>(&value)) {
            const auto file = file_word(*word);
            key += file ? "file:" + std::string(file->hash) : *word;
        }
        if (const auto* count = std::get_if<std::int64_t>(&value)) key += std::to_string(*count);
        if (const auto* real = std::get_if<double>(&value)) key += sentence("%.17g", *real + 0.0);
        key += "\n";
    }
    return key;
}

}  // namespace

double layer_length(const Study& s) {
    return s.travel + s.layer_beyond;
}

double Study::particle_mass() const {
    return dem::sphere_mass(diameter / 2, material.density);
}

double Study::front(double time) const {
    return blade_start + speed * time;
}

double Study::start_of_platform() const {
    return first_gate;
}

Study study_of(const Inputs& in, const Files& files) {
    namespace ask = question;
    Study s;
    s.material = ask::powder.material(in);
    s.sizes = ask::powder.sizes(in, files);
    s.diameter = ask::powder.diameter(in);
    s.gap = ask::gap(in);
    s.speed = ask::speed(in);
    s.gravity = ask::gravity(in);
    s.vibration_amplitude = ask::vibration_amplitude(in);
    s.vibration_frequency = ask::vibration_frequency(in);
    s.width = ask::width(in) * s.diameter;
    s.layer_area = ask::layer_area(in);
    s.travel = ask::travel(in);
    s.layer_beyond = ask::layer_beyond(in);
    s.layers = ask::layers(in);
    s.base = ask::base(in);
    s.blade_start = first_gate;
    s.standard_error = ask::standard_error(in);
    s.bed_seed = ask::bed_seed(in);
    lay_out(s);
    set_up_tool(s, in, files);
    require(s.vibration_frequency == 0 || s.vibration_amplitude < s.gap,
            sentence("a tool vibrating by %.4g m at a gap of %.4g m strikes the base: make vibration_amplitude smaller "
                     "than gap",
                     s.vibration_amplitude, s.gap));

    s.time_step = ask::powder.step(in, s.sizes.smallest() * s.diameter / 2, fastest_impact(s));
    s.step_share = ask::powder.step_share(in);
    const double settle = std::round(ask::settle_time(in) / s.time_step);
    const double sweep = std::round(s.travel / s.speed / s.time_step);
    require(settle + sweep <= most_steps,
            sentence("%.4g time steps of %.4g s are more than can be counted on: soften the particles or speed up the "
                     "tool",
                     settle + sweep, s.time_step));
    require(
        sweep >= static_cast<double>(sweep_samples),
        sentence("a time step of %.4g s leaves %.4g steps for the sweep, too few to measure a flux: make it smaller or "
                 "travel longer",
                 s.time_step, sweep));
    s.settle_steps = std::llround(settle);
    s.sweep_steps = std::llround(sweep);
    require_layers(s);
    if (s.bed_seed > 0) s.bed_key = key_of_bed(in, s);
    return s;
}

}  // namespace grainsweep::spreading
