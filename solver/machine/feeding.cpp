#include "solver/machine/feeding.hpp"

#include "solver/machine/neighbourhood.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace grainsweep::machine {
namespace {

constexpr std::uint64_t tries = 1000;  // of one particle in a batch
constexpr std::uint64_t tries_of_empty = 100000, series_of_empty = ~std::uint64_t{0};

}  // namespace

Feeder::Feeder(const Spec& spec, std::size_t feed, std::uint64_t seed) : spec_(spec), feed_(feed), seed_(seed) {
    for (const auto& [species, share] : spec.feeds[feed].mix)
        largest_ = std::max(largest_, spec.species[species].widest());
}

Vec3 Feeder::place(const Draws& draws, std::uint64_t series, std::uint64_t n) const {
    const auto [low, high] = bounds_in(spec_, feed().through);
    Vec3 x{};
    for (std::size_t k = 0; k < 3; ++k)
        x[k] = low[k] + (high[k] - low[k]) * draws.uniform(place_draw, stats::splitmix64(series) + 3 * n + k);
    return x;
}

bool Feeder::fits(const Obstacles& obstacles, const Vec3& centre, double radius) const {
    if (feed().through.depth(centre) < radius) return false;
    return !spec_.domain.outside(centre) && !obstacles.touch(centre, radius);
}

void Feeder::require_room() const {
    const Draws draws(spec_, feed().mix, seed_, first_feed + feed_);
    std::vector<dem::Wall> still;
    for (const MachineWall& wall : spec_.walls) {
        bool always = wall.motions.empty();
        for (std::size_t p = 0; p < spec_.phases.size(); ++p)
            if (holds(feed().during, p) && !holds(wall.during, p)) always = false;
        still.emplace_back(wall.shape).present = always;
    }
    const Obstacles obstacles(spec_, feed().mix, still, largest_, 0);
    for (std::uint64_t n = 0; n < tries_of_empty; ++n)
        if (fits(obstacles, place(draws, series_of_empty, n), largest_ / 2)) return;
    throw std::invalid_argument(
        feed().name + kit::sentence(": a particle of %.4g m finds no place in its region, even an empty one: it must "
                                    "lie wholly in the region, in the domain and off the walls",
                                    largest_));
}

Filled Feeder::batch(const dem::State& state, const std::vector<dem::Wall>& walls, double time) {
    const Draws draws(spec_, feed().mix, seed_, first_feed + feed_);
    const Obstacles obstacles(spec_, feed().mix, walls, largest_, time);
    double widest = largest_;
    for (const double radius : state.radius) widest = std::max(widest, 2 * radius);
    Neighbourhood near(spec_.domain, widest);
    for (std::size_t i = 0; i < state.id.size(); ++i) near.add(state.position[i], state.radius[i]);

    Filled added;
    while (fed_ < owed_) {
        const auto particle = draws.of_feed(number_);
        const Species& species = spec_.species[particle.species];
        const auto orientation = draws.orientation(particle.species, number_);
        std::optional<Vec3> place;
        for (std::uint64_t n = 0; n < tries && !place; ++n) {
            const Vec3 x = this->place(draws, number_, n);
            if (species.shape && spec_.domain.outside(x)) continue;
            const auto balls = balls_of(spec_, particle, x, orientation);
            if (std::ranges::all_of(balls, [&](const geometry::Ball& ball) {
                    return fits(obstacles, ball.centre, ball.radius) && !near.occupied(ball.centre, ball.radius);
                }))
                place = x;
        }
        if (!place) break;  // it waits, and so do those behind it
        dem::Sphere sphere;
        sphere.position = *place;
        sphere.radius = particle.radius;
        sphere.velocity = feed().velocity;
        for (const auto& ball : balls_of(spec_, particle, *place, orientation)) near.add(ball.centre, ball.radius);
        added.add(spec_, particle.species, sphere, orientation);
        fed_ += species.density(spec_.densities) * particles::sphere_volume(2 * particle.radius);
        ++number_;
    }
    return added;
}

}  // namespace grainsweep::machine
