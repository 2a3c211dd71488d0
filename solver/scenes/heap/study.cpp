#include "solver/scenes/heap/study.hpp"

#include "solver/scenes/heap/question.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::heap {
namespace {

using kit::at_least;
using kit::require;
using kit::sentence;

constexpr double loose_fraction = 0.22;             // of a random filling, where centres can be
constexpr double start_speed = 0.2;                 // sqrt(g D), of the lattice
constexpr double heap_fraction = 0.58;              // of the cone that sets the reach
constexpr double flat_tangent = 0.268;              // of 15 degrees
constexpr double usual_tangent = 0.3;               // of 17 degrees
constexpr double rolling_out = 38;                  // sqrt(D/g), from the flow's end to rest: 27 to 44 in nine heaps
constexpr double beyond_the_cone = 2.5;             // its radii
constexpr double beyond_the_tube = 3;               // its radii
constexpr double glued_share = 0.45;                // of the rough plate's area
constexpr double rough_share = 0.7;                 // of the reach
constexpr double tube_gap = 0.02, tube_wall = 0.2;  // D
constexpr double narrowest = 3;                     // largest diameters
constexpr double rest = 3e-5;                       // sqrt(g D): one of a thousand that still rolls moves faster
constexpr double time_between_looks = 0.05;
constexpr double most_steps = 1e10, most_glued = 2e6;
constexpr std::uint64_t glue_stream = 3;

double solid_volume(const Study& s) {
    return static_cast<double>(s.particles) * particles::sphere_volume(s.diameter) * s.sizes.moment(3);
}

double largest(const Study& s) {
    return s.sizes.largest() * s.diameter;
}

/// Of a loose random filling.
double random_height(const Study& s) {
    const double inset = s.tube_radius - largest(s) / 2;
    return solid_volume(s) / (loose_fraction * std::numbers::pi * inset * inset);
}

kit::TubeLattice lattice_of(const Study& s) {
    return {s.tube_radius, s.diameter, largest(s), s.particles};
}

/// Of the rough part of the plate.
double rough_radius(const Study& s) {
    return rough_share * s.reach();
}

}  // namespace

double Study::reach() const {
    const double cone = std::cbrt(3 * solid_volume(*this) / (heap_fraction * std::numbers::pi * flat_tangent));
    return std::max(beyond_the_cone * cone, beyond_the_tube * tube_radius) + 2 * largest(*this);
}

double Study::glued_spheres() const {
    const double share = rough_radius(*this) / (diameter / 2);
    return rough ? std::floor(glued_share * share * share) : 0;
}

double Study::steps_to_rest() const {
    const double height =
        std::cbrt(3 * solid_volume(*this) * usual_tangent * usual_tangent / (heap_fraction * std::numbers::pi));
    const double time = height / lift_speed + rolling_out * std::sqrt(diameter / gravity);
    return std::min(static_cast<double>(last_step), static_cast<double>(settle_steps) + time / time_step);
}

double Study::rest_speed() const {
    return rest * std::sqrt(gravity * diameter);
}

double Study::lower_end(double time) const {
    const double start = time_step * static_cast<double>(settle_steps);
    return tube_gap * diameter + lift_speed * std::max(0.0, time - start);
}

Study study_of(const Inputs& inputs, const Files& files) {
    namespace q = question;
    Study s;
    s.material = q::powder.material(inputs);
    s.wall = q::powder.wall_surface(inputs);
    s.sizes = q::powder.sizes(inputs, files);
    s.diameter = q::powder.diameter(inputs);
    s.tube_radius = q::tube_diameter(inputs) / 2;
    s.lift_speed = q::lift_speed(inputs);
    s.gravity = q::gravity(inputs);
    s.rough = q::floor(inputs) == q::Floor::rough;
    s.particles = q::particles(inputs);
    require(at_least(2 * s.tube_radius, narrowest * largest(s)),
            sentence("tube_diameter of %.4g m is less than %.0f of the largest particles, %.4g m wide",
                     2 * s.tube_radius, narrowest, largest(s)));
    s.fill_height = std::min(random_height(s), lattice_of(s).height()) + largest(s) + tube_gap * s.diameter;
    require(s.fill_height < 1e3 * s.tube_radius,
            sentence("the particles would fill the tube %.3g of its diameters high: make it wider",
                     s.fill_height / (2 * s.tube_radius)));
    require(s.glued_spheres() <= most_glued,
            sentence("the rough plate would need %.4g glued particles; at most %.4g can be simulated",
                     s.glued_spheres(), most_glued));

    const double fastest = std::max(std::sqrt(2 * s.gravity * s.fill_height), s.lift_speed);
    s.time_step = q::powder.step(inputs, s.sizes.smallest() * s.diameter / 2, fastest);
    const double settle = q::settle_time(inputs), end = q::end_time(inputs);
    require((settle + end) / s.time_step <= most_steps,
            sentence("a time step of %.4g s makes %.4g steps; at most %.4g are computed", s.time_step,
                     (settle + end) / s.time_step, most_steps));
    s.settle_steps = std::llround(std::ceil(settle / s.time_step - 1e-6));
    s.last_step = s.settle_steps + std::max<std::int64_t>(1, std::llround(std::ceil(end / s.time_step - 1e-6)));
    s.steps_per_look = std::max<std::int64_t>(1, std::llround(time_between_looks / s.time_step));
    return s;
}

namespace {

void glue(dem::Setup& setup, const Study& s, std::uint64_t seed) {
    const double out = rough_radius(s), d = s.diameter;
    const particles::Room layer{{-out, -out, -d}, {out, out, 0}, {}, [out](const dem::Vec3& x, double r) {
                                    return std::hypot(x[0], x[1]) + r <= out;
                                }};
    const auto spheres =
        kit::loose_filling({}, d, static_cast<std::int64_t>(s.glued_spheres()), layer,
                           stats::bits_at(seed, glue_stream, 0), "the rough plate cannot hold its glued particles");
    for (dem::Sphere sphere : spheres) {
        sphere.mobile = false;
        setup.spheres.push_back(sphere);
    }
}

/// On a lattice; at random where that is no higher, as in a narrow tube or of very unequal spheres.
std::vector<dem::Sphere> powder_in_tube(const Study& s, std::uint64_t seed) {
    const double floor = tube_gap * s.diameter;
    const auto lattice = lattice_of(s);
    if (lattice.height() < random_height(s))
        return lattice.filled(s.sizes, floor, start_speed * std::sqrt(s.gravity * s.diameter), seed);
    const particles::Room tube{
        {-s.tube_radius, -s.tube_radius, floor},
        {s.tube_radius, s.tube_radius, s.fill_height},
        {},
        [radius = s.tube_radius](const dem::Vec3& x, double r) { return std::hypot(x[0], x[1]) + r <= radius; }};
    return kit::loose_filling(s.sizes, s.diameter, s.particles, tube, seed,
                              "the tube cannot be filled loosely with these particles: make it wider");
}

}  // namespace

dem::Setup filled(const Study& s, std::uint64_t seed) {
    const double out = s.reach(), height = s.fill_height, d = s.diameter;
    dem::Setup setup;
    setup.domain = {{-out, -out, -3 * largest(s)}, {out, out, height + 4 * largest(s)}, {}};
    setup.material = s.material;
    setup.gravity = {0, 0, -s.gravity};
    setup.time_step = s.time_step;
    const double lift_start = s.time_step * static_cast<double>(s.settle_steps);
    setup.walls.emplace_back(dem::Plane{{0, 0, s.rough ? -d : 0}, {0, 0, 1}}, std::vector<geometry::Motion>{}, s.wall);
    setup.walls.emplace_back(
        dem::Tube{.base = {0, 0, tube_gap * d},
                  .axis = {0, 0, 1},
                  .inner = s.tube_radius,
                  .outer = s.tube_radius + tube_wall * d,
                  .length = height},
        std::vector<geometry::Motion>{dem::Translation{.velocity = {0, 0, s.lift_speed}, .start = lift_start}}, s.wall);
    setup.spheres = powder_in_tube(s, seed);
    if (s.rough) glue(setup, s, seed);
    return setup;
}

}  // namespace grainsweep::heap
