#include "solver/scenes/drum/study.hpp"

#include "solver/scenes/drum/question.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::drum {
namespace {

using kit::at_least;
using kit::require;
using kit::sentence;

constexpr double most_steps = 1e10, most_frames = 1e5, most_cells = 1e6;
constexpr double most_particles = 5e6;
constexpr double narrowest_period = 2.5;  // largest diameters: two and the skin of the lists
constexpr double narrowest_drum = 4;      // largest diameters

double drum_volume(const Study& s) {
    return std::numbers::pi * s.radius * s.radius * s.length;
}

void check_size(const Study& s) {
    const double largest = s.sizes.largest() * s.diameter;
    require(at_least(2 * s.radius, narrowest_drum * largest),
            sentence("drum_diameter of %.4g m is less than %.0f of the largest particles, %.4g m wide", 2 * s.radius,
                     narrowest_drum, largest));
    if (s.has_plates)
        require(s.length > largest,
                sentence("a length of %.4g m between plates does not hold the largest particles, %.4g "
                         "m wide",
                         s.length, largest));
    else
        require(at_least(s.length, narrowest_period * largest),
                sentence(
                    "a period of %.4g m (length) is less than %.1f of the largest particles, %.4g m wide: in a shorter "
                    "one a particle would meet another one through two of its images",
                    s.length, narrowest_period, largest));
    const double columns = 2 * std::ceil(s.radius / s.occupancy_cell);
    require(columns * columns <= most_cells,
            sentence("occupancy_cell of %.4g m makes %.4g cells across the drum; at most 1000 by 1000 are kept",
                     s.occupancy_cell, columns));
}

void count_particles(Study& s, const Inputs& inputs) {
    const double one = particles::sphere_volume(s.diameter) * s.sizes.moment(3);
    s.particles = question::particles(inputs);
    if (s.particles == 0) {
        const double wanted = std::round(question::fill(inputs) * packed_fraction * drum_volume(s) / one);
        require(wanted >= 1, sentence("fill asks for less than one particle of diameter %.4g m", s.diameter));
        require(wanted <= most_particles,
                sentence("fill asks for %.4g particles; at most %.4g can be simulated: make the drum smaller or the "
                         "diameter larger",
                         wanted, most_particles));
        s.particles = std::llround(wanted);
    }
    const double fraction = static_cast<double>(s.particles) * one / drum_volume(s);
    require(
        fraction <= kit::most_loose_fraction,
        sentence("the drum is filled loosely, without contacts, before it turns: %.4g of its volume are spheres, and "
                 "at most %.2f can be (a fill of %.2f)",
                 fraction, kit::most_loose_fraction, kit::most_loose_fraction / packed_fraction));
}

}  // namespace

std::int64_t Study::step_of_frame(std::int64_t frame) const {
    // A time that is a whole number of steps but for rounding is that number.
    const double steps = (turning_time + static_cast<double>(frame) * frame_interval) / time_step;
    return std::llround(std::ceil(steps - 1e-6));
}

Study study_of(const Inputs& inputs, const Files& files) {
    namespace q = question;
    Study s;
    s.material = q::powder.material(inputs);
    s.wall = q::powder.wall_surface(inputs);
    s.plates = s.wall;
    if (const auto own = kit::own(q::end_friction, inputs)) s.plates.friction = own;
    s.sizes = q::powder.sizes(inputs, files);
    s.diameter = q::powder.diameter(inputs);
    s.radius = q::drum_diameter(inputs) / 2;
    s.length = q::length(inputs);
    s.has_plates = q::ends(inputs) == q::Ends::plates;
    s.speed = 2 * std::numbers::pi * q::rpm(inputs) / 60;
    s.gravity = q::gravity(inputs);
    const double cell = q::occupancy_cell(inputs);
    s.occupancy_cell = cell > 0 ? cell : s.diameter;
    check_size(s);
    count_particles(s, inputs);

    // The first particles fall through the whole drum.
    const double fastest = std::sqrt(2 * s.gravity * 2 * s.radius) + s.wall_speed();
    s.time_step = q::powder.step(inputs, s.sizes.smallest() * s.diameter / 2, fastest);
    s.turning_time = q::turning_time(inputs);
    s.frame_interval = q::frame_interval(inputs);
    const double measured = q::measured_time(inputs);
    require(measured >= s.frame_interval,
            sentence("measured_time of %.4g s is less than one frame_interval, %.4g s", measured, s.frame_interval));
    require(s.frame_interval >= s.time_step,
            sentence("frame_interval of %.4g s is less than the time step, %.4g s", s.frame_interval, s.time_step));
    const double frames = std::floor(measured / s.frame_interval + 1e-6) + 1;
    require(frames <= most_frames,
            sentence("measured_time and frame_interval make %.4g frames; at most %.4g are taken", frames, most_frames));
    s.frames = std::llround(frames);
    require((s.turning_time + measured) / s.time_step <= most_steps,
            sentence("a time step of %.4g s makes %.4g steps; at most %.4g are computed", s.time_step,
                     (s.turning_time + measured) / s.time_step, most_steps));
    return s;
}

dem::Setup filled(const Study& s, std::uint64_t seed) {
    const double margin = 2 * s.sizes.largest() * s.diameter;
    const double out = s.radius + margin;
    dem::Setup setup;
    setup.domain = {{-out, s.has_plates ? -margin : 0, -out},
                    {out, s.has_plates ? s.length + margin : s.length, out},
                    {false, !s.has_plates, false}};
    setup.material = s.material;
    setup.gravity = {0, 0, -s.gravity};
    setup.time_step = s.time_step;
    const std::vector<geometry::Motion> turning = {dem::Rotation{.point = {}, .axis = {0, 1, 0}, .speed = s.speed}};
    setup.walls.emplace_back(
        dem::Cylinder{.point = {}, .axis = {0, 1, 0}, .radius = s.radius, .side = dem::Side::inside}, turning, s.wall);
    if (s.has_plates) {
        setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 1, 0}}, turning, s.plates);
        setup.walls.emplace_back(dem::Plane{{0, s.length, 0}, {0, -1, 0}}, turning, s.plates);
    }
    const particles::Room room{
        {-s.radius, 0, -s.radius},
        {s.radius, s.length, s.radius},
        {false, !s.has_plates, false},
        [radius = s.radius](const dem::Vec3& x, double r) { return std::hypot(x[0], x[2]) + r <= radius; }};
    setup.spheres = kit::loose_filling(s.sizes, s.diameter, s.particles, room, seed,
                                       "the drum cannot be filled loosely with so many particles: make fill or "
                                       "particles smaller");
    return setup;
}

}  // namespace grainsweep::drum
