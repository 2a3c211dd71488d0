#include "solver/scenes/hopper/study.hpp"

#include "solver/scenes/hopper/question.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::hopper {
namespace {

using kit::at_least;
using kit::require;
using kit::sentence;

constexpr double loose_fraction = 0.22;  // of the filling, where centres can be
constexpr double floor_thickness = 0.1;  // D
constexpr double fall = 4;               // largest diameters below the opening
constexpr double narrowest = 3;          // largest diameters, of the container
constexpr double shortest_period = 2.5;  // largest diameters: two and the skin of the lists
constexpr double quiet = 10;             // sqrt(opening/g)
constexpr double most_steps = 1e10, most_frames = 1e6;

double largest(const Study& s) {
    return s.sizes.largest() * s.diameter;
}

void check_size(const Study& s) {
    require(at_least(2 * s.half_width, narrowest * largest(s)),
            sentence("container_diameter of %.4g m is less than %.0f of the largest particles, %.4g m wide",
                     2 * s.half_width, narrowest, largest(s)));
    require(s.opening < 2 * s.half_width, sentence("opening_size of %.4g m is not less than container_diameter, %.4g m",
                                                   s.opening, 2 * s.half_width));
    require(!(s.conical && s.slot), "a conical hopper has a round opening: a slot needs the shape 'flat'");
    require(!s.slot || at_least(s.slot_length, shortest_period * largest(s)),
            sentence("a period of %.4g m (slot_length) is less than %.1f of the largest particles, %.4g m wide: in a "
                     "shorter one a particle would meet another one through two of its images",
                     s.slot_length, shortest_period, largest(s)));
}

void lay_out_times(Study& s, const Inputs& inputs) {
    namespace q = question;
    const double fastest = std::sqrt(2 * s.gravity * s.fill_height());
    s.time_step = q::powder.step(inputs, s.sizes.smallest() * s.diameter / 2, fastest);
    s.frame_interval = q::frame_interval(inputs);
    s.stop_share = q::stop_share(inputs);
    const double settle = q::settle_time(inputs), end = q::end_time(inputs);
    require(s.frame_interval >= s.time_step,
            sentence("frame_interval of %.4g s is less than the time step, %.4g s", s.frame_interval, s.time_step));
    require(end >= s.frame_interval,
            sentence("end_time of %.4g s is less than one frame_interval, %.4g s", end, s.frame_interval));
    require(end / s.frame_interval <= most_frames,
            sentence("end_time and frame_interval make %.4g frames; at most %.4g "
                     "are taken",
                     end / s.frame_interval, most_frames));
    require((settle + end) / s.time_step <= most_steps,
            sentence("a time step of %.4g s makes %.4g steps; at most %.4g are computed", s.time_step,
                     (settle + end) / s.time_step, most_steps));
    s.settle_steps = std::llround(std::ceil(settle / s.time_step - 1e-6));
    s.frames = std::llround(std::floor(end / s.frame_interval + 1e-6)) + 1;
}

}  // namespace

double Study::cone_height() const {
    return conical ? (half_width - opening / 2) / cone_tangent : 0;
}

double Study::section() const {
    return slot ? 2 * half_width * slot_length : std::numbers::pi * half_width * half_width;
}

double Study::fill_height() const {
    const double one = particles::sphere_volume(diameter) * sizes.moment(3);
    const double inset = half_width - sizes.largest() * diameter / 2;
    const double section = slot ? 2 * inset * slot_length : std::numbers::pi * inset * inset;
    // In the cone about a third of a cylinder of its height has room.
    return static_cast<double>(particles) * one / (loose_fraction * section) + cone_height() +
           sizes.largest() * diameter;
}

std::int64_t Study::step_of_frame(std::int64_t frame) const {
    const double steps = static_cast<double>(frame) * frame_interval / time_step;
    return settle_steps + std::llround(std::ceil(steps - 1e-6));
}

double Study::time_of_frame(std::int64_t frame) const {
    return time_step * static_cast<double>(step_of_frame(frame) - settle_steps);
}

double Study::quiet_time() const {
    return quiet * std::sqrt(opening / gravity);
}

Study study_of(const Inputs& inputs, const Files& files) {
    namespace q = question;
    Study s;
    s.material = q::powder.material(inputs);
    s.wall = q::powder.wall_surface(inputs);
    s.sizes = q::powder.sizes(inputs, files);
    s.diameter = q::powder.diameter(inputs);
    s.conical = q::shape(inputs) == q::Floor::conical;
    s.slot = q::opening(inputs) == q::Opening::slot;
    s.cone_tangent = std::tan(q::half_angle(inputs) * std::numbers::pi / 180);
    s.half_width = q::container_diameter(inputs) / 2;
    s.opening = q::opening_size(inputs);
    s.slot_length = q::slot_length(inputs);
    s.gravity = q::gravity(inputs);
    s.particles = q::particles(inputs);
    check_size(s);
    require(s.fill_height() < 1e3 * s.half_width,
            sentence("the particles would fill the container %.3g of its widths high: make it wider",
                     s.fill_height() / (2 * s.half_width)));
    lay_out_times(s, inputs);
    return s;
}

namespace {

/// What stands while the powder settles and while it flows.
std::vector<dem::Wall> container(const Study& s) {
    std::vector<dem::Wall> walls;
    if (s.slot) {
        walls.emplace_back(dem::Plane{{-s.half_width, 0, 0}, {1, 0, 0}}, std::vector<geometry::Motion>{}, s.wall);
        walls.emplace_back(dem::Plane{{s.half_width, 0, 0}, {-1, 0, 0}}, std::vector<geometry::Motion>{}, s.wall);
        return walls;
    }
    walls.emplace_back(dem::Cylinder{.point = {}, .axis = {0, 0, 1}, .radius = s.half_width, .side = dem::Side::inside},
                       std::vector<geometry::Motion>{}, s.wall);
    if (s.conical)
        walls.emplace_back(dem::Cone{.base = {},
                                     .axis = {0, 0, 1},
                                     .base_radius = s.opening / 2,
                                     .end_radius = s.half_width,
                                     .length = s.cone_height(),
                                     .side = dem::Side::inside},
                           std::vector<geometry::Motion>{}, s.wall);
    return walls;
}

}  // namespace

std::vector<dem::Wall> open_walls(const Study& s) {
    auto walls = container(s);
    if (s.conical) return walls;
    const double thickness = floor_thickness * s.diameter, beyond = s.half_width + largest(s);
    if (s.slot) {
        for (const double front : {-s.opening / 2, beyond})
            walls.emplace_back(
                dem::Bar{.front = front, .thickness = beyond - s.opening / 2, .bottom = -thickness, .top = 0},
                std::vector<geometry::Motion>{}, s.wall);
        return walls;
    }
    walls.emplace_back(dem::Tube{.base = {0, 0, -thickness},
                                 .axis = {0, 0, 1},
                                 .inner = s.opening / 2,
                                 .outer = beyond,
                                 .length = thickness},
                       std::vector<geometry::Motion>{}, s.wall);
    return walls;
}

dem::Setup closed(const Study& s, std::uint64_t seed) {
    const double margin = 2 * largest(s), out = s.half_width + margin, height = s.fill_height();
    dem::Setup setup;
    setup.domain = {{-out, s.slot ? 0 : -out, -fall * largest(s)},
                    {out, s.slot ? s.slot_length : out, height + margin},
                    {false, s.slot, false}};
    setup.material = s.material;
    setup.gravity = {0, 0, -s.gravity};
    setup.time_step = s.time_step;
    setup.walls = container(s);
    setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}}, std::vector<geometry::Motion>{}, s.wall);

    particles::Room room{{-s.half_width, s.slot ? 0 : -s.half_width, 0},
                         {s.half_width, s.slot ? s.slot_length : s.half_width, height},
                         {false, s.slot, false},
                         {}};
    if (!s.slot) {
        const double sine = s.cone_tangent / std::hypot(1, s.cone_tangent), cosine = sine / s.cone_tangent;
        room.holds = [radius = s.half_width, tip = s.opening / 2, sine, cosine, conical = s.conical](const dem::Vec3& x,
                                                                                                     double r) {
            const double from_axis = std::hypot(x[0], x[1]);
            return from_axis + r <= radius && (!conical || (tip - from_axis) * cosine + x[2] * sine >= r);
        };
    }
    setup.spheres = kit::loose_filling(s.sizes, s.diameter, s.particles, room, seed,
                                       "the container cannot be filled loosely with these particles: make it wider");
    return setup;
}

}  // namespace grainsweep::hopper
