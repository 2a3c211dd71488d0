#include "solver/machine/filling.hpp"

#include "solver/machine/setup.hpp"
#include "solver/particles/near_pairs.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::machine {
namespace {

using geometry::norm;
using geometry::operator-;
using kit::require;
using kit::sentence;

constexpr double most_jitter = 0.05, lowest = 0.1;      // D
constexpr double spacing = 1.15, least_spacing = 1.02;  // D, largest diameters
constexpr double most_sites = 2e8;
constexpr double rounding = 1e-9;  // of a radius: a layer one diameter thick holds spheres

double widest_in(const Spec& spec, const Mix& mix) {
    double largest = 0;
    for (const auto& [species, share] : mix)
        if (share > 0) largest = std::max(largest, spec.species[species].largest());
    return largest;
}

/// Places of a lattice: their distance, and how far particles are off them in each direction, so that none touch.
struct Pitch {
    double distance = 0, jitter = 0, largest = 0;

    Pitch(const Spec& spec, const Mix& mix) : largest(widest_in(spec, mix)) {
        double diameter = 0;
        for (const auto& [species, share] : mix)
            if (share > 0) diameter = std::max(diameter, spec.species[species].diameter);
        distance = std::max(spacing * diameter, least_spacing * largest);
        jitter = std::min(most_jitter * diameter, (distance - largest) / 2);
    }
};

std::string name_of(const Spec& spec, const Mix& mix) {
    std::string names;
    for (const auto& [species, share] : mix) names += (names.empty() ? "" : " and ") + spec.species[species].name;
    return names;
}

/// The region as far as it is in the domain.
Bounds bounds_in(const Spec& spec, const Region& region) {
    Bounds bounds = region.bounds();
    for (std::size_t k = 0; k < 3; ++k) {
        bounds.low[k] = std::max(bounds.low[k], spec.domain.low[k]);
        bounds.high[k] = std::min(bounds.high[k], spec.domain.high[k]);
    }
    return bounds;
}

/// Axes along which the bounds reach from one periodic face to the other.
std::array<bool, 3> periodic_in(const Spec& spec, const Bounds& bounds) {
    std::array<bool, 3> periodic{};
    for (std::size_t k = 0; k < 3; ++k)
        periodic[k] =
            spec.domain.periodic[k] && bounds.low[k] <= spec.domain.low[k] && bounds.high[k] >= spec.domain.high[k];
    return periodic;
}

/// A cubic lattice, stretched across so that it reaches from side to side, layers from the bottom up.
class Lattice {
public:
    /// `room`: between the bounds and the outermost places.
    Lattice(const Bounds& bounds, const std::array<bool, 3>& periodic, double distance, double room) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double width = bounds.high[k] - bounds.low[k], between = width - 2 * room;
            if (periodic[k]) {
                count_[k] = std::floor(width / distance + 1e-9);
                step_[k] = width / count_[k];
                first_[k] = bounds.low[k] + step_[k] / 2;
                continue;
            }
            count_[k] = between < 0 ? 0 : 1 + std::floor(between / distance + 1e-9);
            step_[k] = k < 2 && count_[k] > 1 ? between / (count_[k] - 1) : distance;
            first_[k] = k < 2 && count_[k] == 1 ? bounds.low[k] + width / 2 : bounds.low[k] + room;
        }
    }
    [[nodiscard]] double sites() const { return count_[0] * count_[1] * count_[2]; }
    /// Calls visit(centre) layer by layer until it returns false.
    template <class Visit>
    void each(Visit&& visit) const {
        for (double z = 0; z < count_[2]; ++z)
            for (double y = 0; y < count_[1]; ++y)
                for (double x = 0; x < count_[0]; ++x)
                    if (!visit(Vec3{first_[0] + x * step_[0], first_[1] + y * step_[1], first_[2] + z * step_[2]}))
                        return;
    }

private:
    std::array<double, 3> count_{}, step_{}, first_{};
};

/// Whether a sphere of the radius, somewhat away from the centre, lies in the region, in the domain and touches no
/// wall.
bool fits(const Spec& spec, const Obstacles& obstacles, const Region& region, const Vec3& centre, double room) {
    if (region.depth(centre) < room) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        if (spec.domain.periodic[k]) continue;
        if (centre[k] < spec.domain.low[k] || centre[k] > spec.domain.high[k]) return false;
    }
    return !obstacles.touch(centre, room);
}

class Filler {
public:
    Filler(const Spec& spec, std::uint64_t seed, Filled& into) : spec_(spec), seed_(seed), into_(into) {}

    void operator()(const std::vector<Placed>& placed) {
        for (const Placed& one : placed) {
            require_in_domain(one);
            add(one.sphere, one.species);
        }
        begin_ = into_.spheres.size();
        ++number_;
    }

    void operator()(const Fill& fill) {
        const Draws draws(spec_, fill.mix, seed_, number_);
        const auto particles = draws.in_numbers(fill.count);
        const double largest = widest_in(spec_, fill.mix);
        const Obstacles obstacles(walls_in(spec_, 0, {{0.0}, {}}), spec_.domain, largest, 0);
        const auto centres = fill.as == Fill::As::lattice ? on_lattice(fill, draws, obstacles)
                                                          : at_random(fill, draws, particles, obstacles);
        for (std::size_t n = 0; n < particles.size(); ++n) {
            dem::Sphere sphere;
            sphere.position = centres[n];
            sphere.radius = particles[n].radius;
            sphere.mobile = !fill.glued;
            if (!fill.glued) sphere.velocity = fill.velocity;
            for (std::size_t k = 0; k < 3; ++k)
                if (fill.shaken > 0 && !fill.glued)
                    sphere.velocity[k] += fill.shaken * (2 * draws.uniform(velocity_draw, 3 * n + k) - 1);
            add(sphere, particles[n].species);
        }
        loose_.push_back({begin_, into_.spheres.size()});
        begin_ = into_.spheres.size();
        ++number_;
    }

    /// Throws where particles of two fillings overlap.
    void require_apart() const {
        if (loose_.size() < 2) return;
        std::vector<Vec3> centres;
        double largest = 0;
        for (const auto& sphere : into_.spheres) {
            centres.push_back(sphere.position);
            largest = std::max(largest, 2 * sphere.radius);
        }
        particles::for_each_near_pair(centres, largest, [&](std::size_t i, std::size_t j, double distance) {
            const auto a = filling_of(i), b = filling_of(j);
            if (a == b || a == loose_.size() || b == loose_.size()) return;
            if (distance < into_.spheres[i].radius + into_.spheres[j].radius)
                throw std::invalid_argument("particles of two fillings overlap at (" +
                                            sentence("%.4g, %.4g, %.4g) m: give them regions apart", centres[i][0],
                                                     centres[i][1], centres[i][2]));
        });
    }

private:
    struct Range {
        std::size_t begin, end;
    };

    [[nodiscard]] std::size_t filling_of(std::size_t i) const {
        for (std::size_t k = 0; k < loose_.size(); ++k)
            if (i >= loose_[k].begin && i < loose_[k].end) return k;
        return loose_.size();
    }

    void require_in_domain(const Placed& one) const {
        const Vec3& x = one.sphere.position;
        for (std::size_t k = 0; k < 3; ++k)
            require(spec_.domain.periodic[k] || (x[k] >= spec_.domain.low[k] && x[k] <= spec_.domain.high[k]),
                    spec_.species[one.species].name +
                        sentence(": a sphere at (%.4g, %.4g, %.4g) m lies outside of the domain", x[0], x[1], x[2]));
    }

    void add(dem::Sphere sphere, std::size_t species) {
        sphere.kind = spec_.species[species].material;
        into_.spheres.push_back(sphere);
        into_.species.push_back(static_cast<std::uint8_t>(species));
    }

    std::vector<Vec3> on_lattice(const Fill& fill, const Draws& draws, const Obstacles& obstacles) {
        const Pitch pitch(spec_, fill.mix);
        const double room = pitch.largest / 2 + std::numbers::sqrt3 * pitch.jitter;
        const Bounds bounds = bounds_in(spec_, fill.in);
        const Lattice lattice(bounds, periodic_in(spec_, bounds), pitch.distance, room);
        require(lattice.sites() < most_sites,
                "the region of a filling has more than 2e8 places for particles: make it smaller");
        const auto wanted = static_cast<std::size_t>(fill.count);
        std::vector<Vec3> centres;
        lattice.each([&](const Vec3& site) {
            if (centres.size() == wanted) return false;
            if (fits(spec_, obstacles, fill.in, site, room * (1 - rounding))) centres.push_back(site);
            return true;
        });
        require(centres.size() == wanted,
                name_of(spec_, fill.mix) +
                    sentence(": %.0f of %.0f particles fit into the region on a lattice of 1.15 diameters: make the "
                             "region larger or the number smaller",
                             static_cast<double>(centres.size()), static_cast<double>(wanted)));
        for (std::size_t n = 0; n < centres.size(); ++n)
            for (std::size_t k = 0; k < 3; ++k)
                centres[n][k] += pitch.jitter * (2 * draws.uniform(place_draw, 3 * n + k) - 1);
        return centres;
    }

    std::vector<Vec3> at_random(const Fill& fill, const Draws& draws, const std::vector<Draws::Particle>& particles,
                                const Obstacles& obstacles) {
        std::vector<double> radii;
        for (const auto& particle : particles) radii.push_back(particle.radius);
        const Bounds bounds = bounds_in(spec_, fill.in);
        const particles::Room room{bounds.low, bounds.high, periodic_in(spec_, bounds),
                                   [&](const Vec3& centre, double radius) {
                                       return fits(spec_, obstacles, fill.in, centre, radius * (1 - rounding));
                                   }};
        const auto seed = static_cast<std::uint64_t>(draws.uniform(order_draw, 1) * 0x1p53);
        auto centres = particles::random_addition(room, radii, seed);
        require(centres.has_value(), name_of(spec_, fill.mix) +
                                         ": so many particles find no place at random without overlap: make the region "
                                         "larger, the number smaller, or fill \"as\": \"lattice\"");
        return *centres;
    }

    const Spec& spec_;
    std::uint64_t seed_;
    Filled& into_;
    std::uint64_t number_ = 0;
    std::size_t begin_ = 0;
    std::vector<Range> loose_;
};

}  // namespace

Draws::Draws(const Spec& spec, const Mix& mix, std::uint64_t seed, std::uint64_t number)
    : spec_(spec), mix_(mix), seed_(seed), number_(number) {}

double Draws::uniform(std::uint64_t purpose, std::uint64_t counter) const {
    return stats::to_unit(stats::bits_at(seed_, number_ * draws_of_one + purpose, counter));
}

double Draws::radius_of(std::size_t species, std::uint64_t n) const {
    const Species& s = spec_.species[species];
    return s.diameter / 2 * (s.sizes.equal() ? 1 : s.sizes.diameter(uniform(size_draw, n)));
}

Draws::Particle Draws::by_chance(std::uint64_t n) const {
    double u = mix_.size() > 1 ? uniform(species_draw, n) : 0;
    std::size_t species = mix_.back().first;
    for (const auto& [candidate, share] : mix_) {
        if (u < share) {
            species = candidate;
            break;
        }
        u -= share;
    }
    return {species, radius_of(species, n)};
}

std::vector<Draws::Particle> Draws::in_numbers(std::int64_t count) const {
    // Whole numbers of each by the largest remainders of the shares.
    std::vector<std::size_t> species;
    double owed = 0;
    for (const auto& [candidate, share] : mix_) {
        owed += share * static_cast<double>(count);
        while (static_cast<double>(species.size()) + 0.5 <= owed && static_cast<std::int64_t>(species.size()) < count)
            species.push_back(candidate);
    }
    while (static_cast<std::int64_t>(species.size()) < count) species.push_back(mix_.back().first);
    if (mix_.size() > 1) {
        const auto order =
            stats::permutation(static_cast<std::uint32_t>(count),
                               stats::Generator(stats::bits_at(seed_, number_ * draws_of_one + order_draw, 0)));
        std::vector<std::size_t> shuffled(species.size());
        for (std::size_t n = 0; n < species.size(); ++n) shuffled[n] = species[order[n]];
        species = std::move(shuffled);
    }
    std::vector<Particle> particles;
    for (std::size_t n = 0; n < species.size(); ++n) particles.push_back({species[n], radius_of(species[n], n)});
    return particles;
}

Obstacles::Obstacles(const std::vector<dem::Wall>& walls, const geometry::Domain& domain, double largest, double time) {
    for (const dem::Wall& wall : walls) {
        if (!wall.present) continue;
        walls_.emplace_back(wall, domain, largest);
        walls_.back().place(time);
    }
}

bool Obstacles::touch(const Vec3& centre, double radius) const {
    std::vector<dem::WallTouch> touches;
    for (const auto& wall : walls_) wall.find(0, centre, radius, touches);
    return !touches.empty();
}

Filled filled(const Spec& spec, std::uint64_t seed) {
    Filled all;
    Filler filler(spec, seed, all);
    for (const auto& fill : spec.fills) std::visit(filler, fill);
    filler.require_apart();
    return all;
}

}  // namespace grainsweep::machine
