#include "solver/scenes/spreading/study.hpp"

#include "solver/dem/material.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/scenes/scene.hpp"
#include "solver/scenes/spreading/question.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <stdexcept>

namespace grainsweep::spreading {
namespace {

constexpr double first_gate = 0.015;     // m
constexpr double beyond_travel = 0.020;  // m, from the end of the travel to the second gate
constexpr double space_behind = 0.075;   // m, from the first gate to the open face
constexpr double space_ahead = 0.195;    // m, from the second gate to the open face
constexpr double blade_top = 0.150;      // m: nothing jumps over it
constexpr double domain_top = 0.160;     // m
constexpr double spacing = 1.1;          // of the lattice, in diameters
constexpr double jitter = 0.05;          // in diameters; also the margin to walls
constexpr double loose_fraction = 0.25;  // of unequal spheres at the start
constexpr double start_velocity = 0.1;   // m/s
constexpr double most_particles = 5e6;
constexpr double most_steps = 1e10;

enum : std::uint64_t {
    position_stream = 1,
    velocity_stream = 2,
    size_stream = 3,
    place_stream = 4,
    bed_stream = 5,
    start_stream = 6
};

std::string text(const char* format, double a, double b = 0) {
    char buffer[240];
    std::snprintf(buffer, sizeof buffer, format, a, b);
    return buffer;
}

void require(bool holds, const std::string& sentence) {
    if (!holds) throw std::invalid_argument(sentence);
}

double sphere_volume(double diameter) {
    return std::numbers::pi / 6 * diameter * diameter * diameter;
}

/// Height of the layer at the start: of the lattice, or of the tray unequal spheres are added to.
double start_height(const Study& s) {
    if (!s.sizes.equal()) return s.layer_area / (loose_fraction * layer_length(s)) + s.sizes.largest() * s.diameter;
    const auto layers = std::ceil(static_cast<double>(s.particles) / static_cast<double>(s.lattice_x * s.lattice_y));
    return (2 * jitter + spacing * layers) * s.diameter;
}

/// Largest expected impact speed: particles thrown ahead by the blade fall back on it; all fall once at the start.
double fastest_impact(const Study& s) {
    const double shaking = 2 * std::numbers::pi * s.vibration_frequency * s.vibration_amplitude;
    return std::max(2 * std::hypot(s.speed, shaking), start_velocity + std::sqrt(2 * s.gravity * start_height(s)));
}

void lay_out(Study& s) {
    const double volume = sphere_volume(s.diameter) * s.sizes.moment(3);
    const double wanted = std::round(s.layer_area * s.width / volume);
    require(wanted >= 1, text("layer_area of %.4g m2 holds no particle of diameter %.4g m", s.layer_area, s.diameter));
    require(wanted <= most_particles,
            text("layer_area and width ask for %.4g particles; at most %.4g can be simulated: make the layer or the "
                 "width smaller or the diameter larger",
                 wanted, most_particles));
    s.particles = std::llround(wanted);
    s.lattice_x = static_cast<std::int64_t>((layer_length(s) - 2 * jitter * s.diameter) / (spacing * s.diameter));
    s.lattice_y = static_cast<std::int64_t>(s.width / (spacing * s.diameter));
    require(s.lattice_x >= 1 && layer_length(s) >= 2 * s.sizes.largest() * s.diameter,
            text("a layer of %.4g m cannot hold particles of diameter %.4g m: make travel longer", layer_length(s),
                 s.diameter));
    require(2 * s.sizes.largest() * s.diameter <= s.width,
            text("the largest particles, %.4g diameters, are wider than half the width of %.4g diameters: make width "
                 "larger",
                 s.sizes.largest(), s.width / s.diameter));
    require(start_height(s) < domain_top, text("the layer would start %.4g m high, above the top of the domain at "
                                               "%.4g m: make layer_area smaller",
                                               start_height(s), domain_top));
    require(s.gap < blade_top, text("a gap of %.4g m lies above the top of the blade at %.4g m", s.gap, blade_top));
}

/// Every input but those without effect before the blade starts; the time step, which may follow from some of
/// them, as it is.
std::string key_of_bed(const Inputs& inputs, const Study& s) {
    static const std::set<std::string, std::less<>> without_effect = {"gap",
                                                                      "speed",
                                                                      "vibration_amplitude",
                                                                      "vibration_frequency",
                                                                      "blade_thickness",
                                                                      "blade_edge_radius",
                                                                      "time_step",
                                                                      "time_step_fraction",
                                                                      "standard_error"};
    std::string key = "powder_spreading: settled bed\nrevision=" + std::to_string(revision) +
                      "\npath=" + std::string(instruction_path()) +
                      text("\ntime step=%.17g\nsteps=%.17g\n", s.time_step, static_cast<double>(s.settle_steps));
    for (const auto& [name, value] : inputs) {
        if (without_effect.contains(name)) continue;
        key += name + "=";
        if (const auto* word = std::get_if<std::string>(&value)) {
            const auto file = file_word(*word);
            key += file ? "file:" + std::string(file->hash) : *word;
        }
        if (const auto* count = std::get_if<std::int64_t>(&value)) key += std::to_string(*count);
        if (const auto* real = std::get_if<double>(&value)) key += text("%.17g", *real + 0.0);
        key += "\n";
    }
    return key;
}

}  // namespace

double layer_length(const Study& s) {
    return s.travel + beyond_travel;
}

double Study::particle_mass() const {
    return dem::sphere_mass(diameter / 2, material.density);
}

double Study::front(double time) const {
    return blade_start + speed * time;
}

Study study_of(const Inputs& in, const Files* files) {
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
    s.blade_thickness = ask::blade_thickness(in);
    s.blade_edge_radius = ask::blade_edge_radius(in);
    s.blade_start = first_gate;
    s.standard_error = ask::standard_error(in);
    s.bed_seed = ask::bed_seed(in);
    lay_out(s);
    require(s.vibration_frequency == 0 || s.vibration_amplitude < s.gap,
            text("a blade vibrating by %.4g m at a gap of %.4g m strikes the base: make vibration_amplitude smaller "
                 "than gap",
                 s.vibration_amplitude, s.gap));
    require(2 * s.blade_edge_radius <= s.blade_thickness,
            text("blade_edge_radius of %.4g m exceeds half the blade_thickness of %.4g m", s.blade_edge_radius,
                 s.blade_thickness));

    s.time_step = ask::powder.step(in, s.sizes.smallest() * s.diameter / 2, fastest_impact(s));
    const double settle = std::round(ask::settle_time(in) / s.time_step);
    const double sweep = std::round(s.travel / s.speed / s.time_step);
    require(settle + sweep <= most_steps,
            text("%.4g time steps of %.4g s are more than can be counted on: soften the particles or speed up the "
                 "blade",
                 settle + sweep, s.time_step));
    require(sweep >= static_cast<double>(sweep_samples),
            text("a time step of %.4g s leaves %.4g steps for the sweep, too few to measure a flux: make it smaller or "
                 "travel longer",
                 s.time_step, sweep));
    s.settle_steps = std::llround(settle);
    s.sweep_steps = std::llround(sweep);
    if (s.bed_seed > 0) s.bed_key = key_of_bed(in, s);
    return s;
}

namespace {

/// Draws until the volume is as near to that of the layer as it gets.
std::vector<double> radii_of(const Study& s, std::uint64_t seed) {
    const stats::Stream size(seed, size_stream);
    const double wanted = s.layer_area * s.width / sphere_volume(s.diameter);
    std::vector<double> radii;
    double volume = 0;
    for (std::uint64_t k = 0;; ++k) {
        const double d = s.sizes.diameter(size.uniform(k));
        const double next = volume + d * d * d;
        if (!radii.empty() && next - wanted > wanted - volume) return radii;
        volume = next;
        radii.push_back(s.diameter * d / 2);
    }
}

void place_on_lattice(dem::Setup& setup, const Study& s, std::uint64_t seed) {
    const double d = s.diameter;
    const stats::Stream position(seed, position_stream);
    const dem::Vec3 step = {(layer_length(s) - 2 * jitter * d) / static_cast<double>(s.lattice_x),
                            s.width / static_cast<double>(s.lattice_y), spacing * d};
    const dem::Vec3 corner = {first_gate + jitter * d, 0, jitter * d};
    setup.spheres.resize(static_cast<std::size_t>(s.particles));
    for (std::int64_t k = 0; k < s.particles; ++k) {
        const std::array<std::int64_t, 3> site = {k % s.lattice_x, k / s.lattice_x % s.lattice_y,
                                                  k / s.lattice_x / s.lattice_y};
        dem::Sphere& sphere = setup.spheres[static_cast<std::size_t>(k)];
        sphere.radius = d / 2;
        for (std::size_t a = 0; a < 3; ++a)
            sphere.position[a] = corner[a] + (static_cast<double>(site[a]) + 0.5) * step[a] +
                                 jitter * d * (2 * position.uniform(static_cast<std::uint64_t>(3 * k) + a) - 1);
    }
}

void place_at_random(dem::Setup& setup, const Study& s, std::uint64_t seed) {
    const auto radii = radii_of(s, seed);
    const particles::Tray tray{{first_gate, 0, 0}, {first_gate + layer_length(s), s.width, start_height(s)}};
    const auto centres = particles::random_addition(tray, radii, stats::bits_at(seed, place_stream, 0));
    setup.spheres.resize(radii.size());
    for (std::size_t k = 0; k < radii.size(); ++k) {
        setup.spheres[k].radius = radii[k];
        setup.spheres[k].position = centres[k];
    }
}

}  // namespace

dem::Setup settling(const Study& s, std::uint64_t seed) {
    const double second_gate = first_gate + layer_length(s);
    dem::Setup setup;
    setup.domain = {
        {first_gate - space_behind, 0, -0.001}, {second_gate + space_ahead, s.width, domain_top}, {false, true, false}};
    setup.material = s.material;
    setup.gravity = {0, 0, -s.gravity};
    setup.time_step = s.time_step;
    setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}, dem::Plane{{first_gate, 0, 0}, {1, 0, 0}},
                   dem::Plane{{second_gate, 0, 0}, {-1, 0, 0}}};
    if (s.sizes.equal())
        place_on_lattice(setup, s, seed);
    else
        place_at_random(setup, s, seed);
    const stats::Stream velocity(seed, velocity_stream);
    for (std::size_t k = 0; k < setup.spheres.size(); ++k)
        for (std::size_t a = 0; a < 3; ++a)
            setup.spheres[k].velocity[a] = start_velocity * (2 * velocity.uniform(3 * k + a) - 1);
    return setup;
}

std::uint64_t seed_of_bed(std::int64_t number) {
    return stats::bits_at(0, bed_stream, static_cast<std::uint64_t>(number));
}

double run_up(const Study& s, std::uint64_t seed) {
    return s.diameter * stats::Stream(seed, start_stream).uniform(0);
}

std::vector<dem::Wall> sweeping_walls(const Study& s) {
    return {dem::Plane{{0, 0, 0}, {0, 0, 1}},
            dem::Blade{.front = s.blade_start,
                       .thickness = s.blade_thickness,
                       .bottom = s.gap,
                       .top = blade_top,
                       .speed = s.speed,
                       .amplitude = s.vibration_frequency > 0 ? s.vibration_amplitude : 0.0,
                       .frequency = s.vibration_frequency,
                       .edge_radius = s.blade_edge_radius}};
}

}  // namespace grainsweep::spreading
