#include "solver/scenes/spreading/filling.hpp"

#include "solver/particles/random_addition.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::spreading {
namespace {

constexpr double space_behind = 0.075;   // m, from the first gate to the open face
constexpr double space_ahead = 0.195;    // m, from the second gate to the open face
constexpr double space_below = 0.001;    // m, from the base to the open face
constexpr double loose_fraction = 0.25;  // of unequal spheres at the start
constexpr double glue_spacing = 1.2;     // of the lattice of a rough base, in diameters
constexpr double glue_jitter = 0.1;      // in diameters, so that none overlap
constexpr double pressed = 0.01;         // of a radius: how far a particle of the bed may stand in a wall

enum : std::uint64_t {
    position_stream = 1,
    velocity_stream = 2,
    size_stream = 3,
    place_stream = 4,
    bed_stream = 5,
    start_stream = 6,
    layer_stream = 7,
    glue_stream = 8
};

/// A rough base: the plane between half-sunk spheres, whose tops are at height 0.
double height_of_base(const Study& s) {
    return s.base == Base::rough ? -s.diameter / 2 : 0.0;
}

/// Draws radii until their volume is as near as possible to the volume of the layer.
std::vector<double> radii_of(const Study& s, std::uint64_t seed) {
    const stats::Stream size(seed, size_stream);
    const double wanted = s.layer_area * s.width / particles::sphere_volume(s.diameter);
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

void place_on_lattice(dem::Setup& setup, const Study& s, std::uint64_t seed, double floor) {
    const double d = s.diameter;
    const stats::Stream position(seed, position_stream);
    const dem::Vec3 step = {(layer_length(s) - 2 * jitter * d) / static_cast<double>(s.lattice_x),
                            s.width / static_cast<double>(s.lattice_y), spacing * d};
    const dem::Vec3 corner = {first_gate + jitter * d, 0, floor + jitter * d};
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

void place_at_random(dem::Setup& setup, const Study& s, std::uint64_t seed, double floor) {
    const auto radii = radii_of(s, seed);
    const particles::Tray tray{{first_gate, 0, floor},
                               {first_gate + layer_length(s), s.width, floor + start_height(s)}};
    const auto centres = particles::random_addition(tray, radii, stats::bits_at(seed, place_stream, 0));
    setup.spheres.resize(radii.size());
    for (std::size_t k = 0; k < radii.size(); ++k) {
        setup.spheres[k].radius = radii[k];
        setup.spheres[k].position = centres[k];
    }
}

void place_powder(dem::Setup& setup, const Study& s, std::uint64_t seed, double floor) {
    if (s.sizes.equal())
        place_on_lattice(setup, s, seed, floor);
    else
        place_at_random(setup, s, seed, floor);
    const stats::Stream velocity(seed, velocity_stream);
    for (std::size_t k = 0; k < setup.spheres.size(); ++k)
        for (std::size_t a = 0; a < 3; ++a)
            setup.spheres[k].velocity[a] = start_velocity * (2 * velocity.uniform(3 * k + a) - 1);
}

struct Lattice {
    std::int64_t along = 0, across = 0;
};

Lattice lattice_of_glue(const Study& s) {
    const auto count = [&](double length) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(length / (glue_spacing * s.diameter)));
    };
    return {count(layer_length(s)), count(s.width)};
}

void glue(dem::Setup& setup, const Study& s, std::uint64_t seed) {
    if (s.base == Base::smooth) return;
    const stats::Stream place(seed, glue_stream);
    const auto [along, across] = lattice_of_glue(s);
    const double dx = layer_length(s) / static_cast<double>(along), dy = s.width / static_cast<double>(across);
    for (std::int64_t k = 0; k < along * across; ++k) {
        const auto shift = [&](std::uint64_t a) {
            return glue_jitter * s.diameter * (2 * place.uniform(2 * static_cast<std::uint64_t>(k) + a) - 1);
        };
        dem::Sphere sphere;
        sphere.radius = s.diameter / 2;
        sphere.mobile = false;
        sphere.position = {first_gate + (static_cast<double>(k % along) + 0.5) * dx + shift(0),
                           (static_cast<double>(k / along) + 0.5) * dy + shift(1), -s.diameter / 2};
        setup.spheres.push_back(sphere);
    }
}

/// The base beside the platform, which rises with the level.
dem::Wall base_before(const Study& s, std::int64_t layer) {
    return dem::Bar{.front = first_gate,
                    .thickness = space_behind / 2,
                    .bottom = height_of_base(s) - s.diameter,
                    .top = s.level(layer)};
}

dem::Wall base_beyond(const Study& s, std::int64_t layer) {
    const double length = first_gate + layer_length(s) + space_ahead / 2 - s.end_of_platform();
    return dem::Bar{.front = s.end_of_platform() + length,
                    .thickness = length,
                    .bottom = height_of_base(s) - s.diameter,
                    .top = s.level(layer)};
}

}  // namespace

double start_height(const Study& s) {
    if (!s.sizes.equal()) return s.layer_area / (loose_fraction * layer_length(s)) + s.sizes.largest() * s.diameter;
    const auto layers = std::ceil(static_cast<double>(s.particles) / static_cast<double>(s.lattice_x * s.lattice_y));
    return (2 * jitter + spacing * layers) * s.diameter;
}

dem::Setup settling(const Study& s, std::uint64_t seed, std::int64_t layer, const dem::State& bed) {
    const double second_gate = first_gate + layer_length(s), level = s.level(layer), base = height_of_base(s);
    double floor = level;
    for (std::size_t k = 0; k < bed.position.size(); ++k) floor = std::max(floor, bed.position[k][2] + bed.radius[k]);
    if (!(floor <= level + domain_top))
        throw std::invalid_argument("the layers below rise above the top of the domain");
    dem::Setup setup;
    setup.domain = {{first_gate - space_behind, 0, base - space_below},
                    {second_gate + space_ahead, s.width, floor + domain_top},
                    {false, true, false}};
    setup.material = s.material;
    setup.gravity = {0, 0, -s.gravity};
    setup.time_step = s.time_step;
    setup.step_share = s.step_share;
    setup.walls = {dem::Plane{{0, 0, base}, {0, 0, 1}}, dem::Plane{{first_gate, 0, 0}, {1, 0, 0}},
                   dem::Plane{{second_gate, 0, 0}, {-1, 0, 0}}};
    if (layer > 0) setup.walls.push_back(base_beyond(s, layer));
    place_powder(setup, s, layer == 0 ? seed : stats::bits_at(seed, layer_stream, static_cast<std::uint64_t>(layer)),
                 floor);
    for (std::size_t k = 0; k < bed.position.size(); ++k)
        setup.spheres.push_back({.position = bed.position[k],
                                 .velocity = bed.velocity[k],
                                 .angular_velocity = bed.angular_velocity[k],
                                 .radius = bed.radius[k]});
    glue(setup, s, seed);
    return setup;
}

std::vector<dem::Wall> sweeping_walls(const Study& s, std::int64_t layer) {
    std::vector<dem::Wall> walls = {dem::Plane{{0, 0, height_of_base(s)}, {0, 0, 1}}, tool_wall(s, s.level(layer))};
    walls[1].integrated = true;
    if (layer == 0) return walls;
    walls.push_back(base_before(s, layer));
    walls.push_back(base_beyond(s, layer));
    return walls;
}

dem::State left_on_platform(const Study& s, std::int64_t layer, const dem::State& state) {
    const double low = s.start_of_platform(), high = s.end_of_platform(), tool = s.level(layer) + s.gap;
    dem::State kept;
    for (std::size_t k = 0; k < state.position.size(); ++k) {
        const auto& x = state.position[k];
        const double r = state.radius[k], within = (1 - pressed) * r;
        if (state.mobile[k] == 0 || x[0] < low + within || x[0] > high - within || x[2] - r > tool) continue;
        kept.id.push_back(state.id[k]);
        kept.position.push_back(x);
        kept.velocity.push_back(state.velocity[k]);
        kept.angular_velocity.push_back(state.angular_velocity[k]);
        kept.radius.push_back(r);
        kept.mobile.push_back(1);
    }
    return kept;
}

std::int64_t glued_particles(const Study& s) {
    if (s.base == Base::smooth) return 0;
    const auto [along, across] = lattice_of_glue(s);
    return along * across;
}

std::uint64_t seed_of_bed(std::int64_t number) {
    return stats::bits_at(0, bed_stream, static_cast<std::uint64_t>(number));
}

double run_up(const Study& s, std::uint64_t seed) {
    return s.diameter * stats::Stream(seed, start_stream).uniform(0);
}

}  // namespace grainsweep::spreading
