#include "solver/machine/feeding.hpp"

#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

namespace grainsweep::machine {
namespace {

using geometry::norm;

constexpr std::uint64_t tries = 1000;  // of one particle in a batch
constexpr std::uint64_t tries_of_empty = 100000, series_of_empty = ~std::uint64_t{0};

/// Spheres by cells of a width, to find those near a place.
class Neighbourhood {
public:
    Neighbourhood(const geometry::Domain& domain, double width) : domain_(domain), width_(width) {}

    void add(const Vec3& centre, double radius) { cells_[cell_of(centre)].push_back({centre, radius}); }
    /// Whether a sphere there would overlap one of them.
    [[nodiscard]] bool occupied(const Vec3& centre, double radius) const {
        for (int image = 0; image < 27; ++image) {
            const Vec3 place = image_of(centre, image);
            if (image != 13 && place == centre) continue;  // no such image
            if (overlaps(place, radius)) return true;
        }
        return false;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct Ball {
        Vec3 centre;
        double radius;
    };

    [[nodiscard]] Cell cell_of(const Vec3& x) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(x[k] / width_));
        return cell;
    }
    [[nodiscard]] Vec3 image_of(const Vec3& x, int image) const {
        const std::array<int, 3> shift = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
        Vec3 moved = x;
        for (std::size_t k = 0; k < 3; ++k)
            if (domain_.periodic[k]) moved[k] += shift[k] * domain_.length(k);
        return moved;
    }
    [[nodiscard]] bool overlaps(const Vec3& centre, double radius) const {
        const Cell middle = cell_of(centre);
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z) {
                    const auto found = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
                    if (found == cells_.end()) continue;
                    for (const Ball& ball : found->second)
                        if (norm(geometry::operator-(ball.centre, centre)) < ball.radius + radius) return true;
                }
        return false;
    }

    const geometry::Domain& domain_;
    double width_;
    std::map<Cell, std::vector<Ball>> cells_;
};

}  // namespace

Feeder::Feeder(const Spec& spec, std::size_t feed, std::uint64_t seed) : spec_(spec), feed_(feed), seed_(seed) {
    for (const auto& [species, share] : spec.feeds[feed].mix)
        largest_ = std::max(largest_, spec.species[species].widest());
}

Vec3 Feeder::place(const Draws& draws, std::uint64_t series, std::uint64_t n) const {
    const Bounds bounds = feed().through.bounds();
    Vec3 x{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = std::max(bounds.low[k], spec_.domain.low[k]);
        const double high = std::min(bounds.high[k], spec_.domain.high[k]);
        x[k] = low + (high - low) * draws.uniform(place_draw, stats::splitmix64(series) + 3 * n + k);
    }
    return x;
}

bool Feeder::fits(const Obstacles& obstacles, const Vec3& centre, double radius) const {
    if (feed().through.depth(centre) < radius) return false;
    for (std::size_t k = 0; k < 3; ++k)
        if (!spec_.domain.periodic[k] && (centre[k] < spec_.domain.low[k] || centre[k] > spec_.domain.high[k]))
            return false;
    return !obstacles.touch(centre, radius);
}

void Feeder::require_room() const {
    const Draws draws(spec_, feed().mix, seed_, first_feed + feed_);
    std::vector<dem::Wall> still;
    for (const MachineWall& wall : spec_.walls) {
        bool always = wall.motions.empty();
        for (std::size_t p = 0; p < spec_.phases.size(); ++p)
            if (holds(feed().during, p) && !holds(wall.during, p)) always = false;
        if (always) still.emplace_back(wall.shape);
    }
    const Obstacles obstacles(still, spec_.domain, largest_, 0);
    for (std::uint64_t n = 0; n < tries_of_empty; ++n)
        if (fits(obstacles, place(draws, series_of_empty, n), largest_ / 2)) return;
    throw std::invalid_argument(
        feed().name + kit::sentence(": a particle of %.4g m finds no place in its region, even an empty one: it must "
                                    "lie wholly in the region, in the domain and off the walls",
                                    largest_));
}

Filled Feeder::batch(const dem::State& state, const std::vector<dem::Wall>& walls, double time) {
    const Draws draws(spec_, feed().mix, seed_, first_feed + feed_);
    const Obstacles obstacles(walls, spec_.domain, largest_, time);
    double widest = largest_;
    for (const double radius : state.radius) widest = std::max(widest, 2 * radius);
    Neighbourhood near(spec_.domain, widest);
    for (std::size_t i = 0; i < state.id.size(); ++i) near.add(state.position[i], state.radius[i]);

    Filled added;
    while (fed_ < owed_) {
        const auto particle = draws.of_feed(number_);
        const Species& species = spec_.species[particle.species];
        const double reach = particle.radius * species.girth();  // of the sphere around it
        std::optional<Vec3> place;
        for (std::uint64_t n = 0; n < tries && !place; ++n) {
            const Vec3 x = this->place(draws, number_, n);
            if (fits(obstacles, x, reach) && !near.occupied(x, reach)) place = x;
        }
        if (!place) break;  // it waits, and so do those behind it
        dem::Sphere sphere;
        sphere.position = *place;
        sphere.radius = particle.radius;
        sphere.velocity = feed().velocity;
        near.add(*place, reach);
        added.add(spec_, particle.species, sphere, draws.orientation(particle.species, number_));
        fed_ += species.density(spec_.densities) * particles::sphere_volume(2 * particle.radius);
        ++number_;
    }
    return added;
}

}  // namespace grainsweep::machine
