#include "solver/machine/filling.hpp"

#include "solver/machine/neighbourhood.hpp"
#include "solver/machine/placing.hpp"
#include "solver/machine/setup.hpp"
#include "solver/particles/near_pairs.hpp"
#include "solver/particles/packing.hpp"
#include "solver/particles/reach.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace grainsweep::machine {
namespace {

constexpr double golden = 1 / std::numbers::phi;
constexpr std::uint64_t first_orientations = std::uint64_t{1} << 40U;  // streams behind those of Draws::uniform()

using geometry::norm;
using geometry::operator*;
using kit::require;
using kit::sentence;

class Filler {
public:
    Filler(const Spec& spec, std::uint64_t seed, Artefacts* artefacts, Filled& into)
        : spec_(spec), seed_(seed), artefacts_(artefacts), into_(into), walls_(walls_in(spec, 0, {{0.0}, {}})) {}

    /// Of a later phase: only fillings of this phase count, among particles and walls as they are.
    void continue_at(std::size_t phase, const dem::State& present, const std::vector<dem::Wall>& walls, double time) {
        phase_ = phase, present_ = &present, walls_ = walls, time_ = time;
    }

    void fill() {
        for (const auto& one : spec_.fills) {
            const auto* fill = std::get_if<Fill>(&one);
            if ((fill != nullptr ? fill->at : 0) == phase_) std::visit([this](const auto& f) { (*this)(f); }, one);
            begin_ = into_.spheres.size();
            ++number_;
        }
    }

    /// Throws if particles of two fillings overlap.
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

    /// Throws if particles stand deep in those that were there.
    void require_apart_from_present() const {
        constexpr double deep = 0.2;  // of a radius
        double largest = 0;
        for (const double radius : present_->radius) largest = std::max(largest, 2 * radius);
        Neighbourhood near(spec_.domain, largest);
        for (std::size_t i = 0; i < present_->id.size(); ++i) near.add(present_->position[i], present_->radius[i]);
        for (std::size_t i = 0; i < into_.spheres.size(); ++i) {
            const Vec3& x = into_.spheres[i].position;
            require(!near.occupied(x, (1 - deep) * into_.spheres[i].radius),
                    spec_.species[into_.species[i]].name +
                        sentence(": the filling of this phase puts a particle into one that is there, at (%.4g, %.4g, "
                                 "%.4g) m: give it \"on_top\" or a region that is empty then",
                                 x[0], x[1], x[2]));
        }
    }

private:
    void operator()(const Cut& cut) {
        const double d = spec_.species[cut.species].diameter;
        const auto& packing = packing_of(cut, cut.edge / d);
        std::vector<Vec3> centres;  // diameters
        for (const Vec3& x : packing.positions)
            if (cut.in.contains(d * x)) centres.push_back(x);
        if (!cut.name.empty()) {
            into_.counts[cut.name + "_particles"] = static_cast<std::int64_t>(centres.size());
            into_.counts[cut.name + "_packing"] = static_cast<std::int64_t>(packing.positions.size());
        }
        require(cut.glued || !centres.empty(),
                spec_.species[cut.species].name +
                    ": no sphere of the packing has its centre in the region, which leaves no space for a mobile "
                    "particle");
        if (cut.tight) leave_out_of_reach(centres, d, 1 - *cut.tight);
        for (const Vec3& x : centres)
            into_.add(spec_, cut.species, {.position = d * x, .radius = d / 2, .mobile = !cut.glued}, {1, 0, 0, 0});
    }

    void operator()(const std::vector<Placed>& placed) {
        for (const Placed& one : placed) {
            require_in_domain(one);
            if (one.named) into_.named.push_back(static_cast<std::int32_t>(into_.spheres.size()));
            into_.add(spec_, one.species, one.sphere, one.orientation.value_or(geometry::Quaternion{1, 0, 0, 0}));
        }
    }

    void operator()(const Fill& given) {
        Fill fill = given;
        if (fill.on_top) raise(fill.in);
        const Draws draws(spec_, fill.mix, seed_, number_);
        const auto particles = fill.drawn_to ? draws.to_volume(*fill.drawn_to) : draws.in_numbers(fill.count);
        fill.count = static_cast<std::int64_t>(particles.size());
        const double largest = widest_in(spec_, fill.mix);
        const Obstacles obstacles(spec_, fill.mix, walls_, largest, time_);
        const auto centres = places_of(spec_, fill, draws, particles, obstacles);
        for (std::size_t n = 0; n < particles.size(); ++n) {
            dem::Sphere sphere;
            sphere.position = centres[n];
            sphere.radius = particles[n].radius;
            sphere.mobile = !fill.glued;
            if (!fill.glued) sphere.velocity = fill.velocity;
            for (std::size_t k = 0; k < 3; ++k)
                if (fill.shaken > 0 && !fill.glued)
                    sphere.velocity[k] += fill.shaken * (2 * draws.uniform(velocity_draw, 3 * n + k) - 1);
            into_.add(spec_, particles[n].species, sphere, draws.orientation(particles[n].species, n));
        }
        loose_.push_back({begin_, into_.spheres.size()});
    }

    struct Range {
        std::size_t begin, end;
    };

    /// Raises a region above the particles whose centres are between its sides.
    void raise(Region& region) const {
        if (present_ == nullptr) return;
        const Bounds bounds = region.bounds();
        double top = bounds.low[2];
        for (std::size_t i = 0; i < present_->id.size(); ++i) {
            const Vec3& x = present_->position[i];
            if (x[0] >= bounds.low[0] && x[0] <= bounds.high[0] && x[1] >= bounds.low[1] && x[1] <= bounds.high[1])
                top = std::max(top, x[2] + present_->radius[i]);
        }
        region = {
            Region::Moving{.of = {region}, .moved = std::make_shared<const Vec3>(Vec3{0, 0, top - bounds.low[2]})}};
    }

    /// The packing of a cut; the next cut may be from the same one.
    const particles::Packing& packing_of(const Cut& cut, double edge) {
        if (!cut.centres.empty()) {
            key_.clear();
            return packing_ = particles::read_packing(cut.centres, edge);
        }
        const auto seed = cut.seed > 0 ? static_cast<std::uint64_t>(cut.seed) : seed_;
        const particles::PackingRequest request{.edge = edge, .fraction = cut.fraction, .seed = seed};
        const std::string key = particles::packing_key(request);
        if (std::exchange(key_, key) == key) return packing_;
        if (const auto kept = artefacts_ != nullptr ? artefacts_->get(key) : std::nullopt) {
            try {
                packing_ = particles::decode_packing(*kept);
                if (packing_.edge == edge && !packing_.positions.empty()) return packing_;
            } catch (const std::invalid_argument&) {  // packed anew below
            }
        }
        packing_ = particles::random_close_packing(request);
        if (artefacts_ != nullptr) artefacts_->put(key, particles::encode(packing_));
        return packing_;
    }

    /// Keeps the glued centres that a mobile sphere can touch, and the outermost ones along each axis, so that the box
    /// around all spheres does not change. In diameters d; `closest` as in particles/reach.hpp.
    void leave_out_of_reach(std::vector<Vec3>& glued, double d, double closest) const {
        if (glued.empty()) return;
        std::vector<Vec3> mobile;
        for (const dem::Sphere& sphere : into_.spheres)
            if (sphere.mobile) mobile.push_back((1 / d) * sphere.position);
        auto stays = particles::reachable(glued, mobile, closest);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] = std::ranges::minmax_element(glued, {}, [axis](const Vec3& x) { return x[axis]; });
            stays[static_cast<std::size_t>(low - glued.begin())] = true;
            stays[static_cast<std::size_t>(high - glued.begin())] = true;
        }
        std::size_t next = 0;
        std::erase_if(glued, [&](const Vec3&) { return !stays[next++]; });
    }

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

    const Spec& spec_;
    std::uint64_t seed_;
    Artefacts* artefacts_;
    Filled& into_;
    std::string key_;
    particles::Packing packing_;
    std::vector<dem::Wall> walls_;
    double time_ = 0;
    const dem::State* present_ = nullptr;
    std::size_t phase_ = 0;
    std::uint64_t number_ = 0;
    std::size_t begin_ = 0;
    std::vector<Range> loose_;
};

/// Throws if one of these spheres starts deep in the wall with this number.
void require_out_of_wall(const Spec& spec, std::size_t number, const dem::MovingWall& wall,
                         const std::vector<Placed>& placed) {
    std::vector<dem::WallTouch> touches;
    Filled members;
    for (const auto& [species, sphere, orientation, named] : placed)
        members.add(spec, species, sphere, orientation.value_or(geometry::Quaternion{1, 0, 0, 0}));
    for (std::size_t k = 0; k < members.spheres.size(); ++k) {
        const std::size_t species = members.species[k];
        const dem::Sphere& sphere = members.spheres[k];
        const Vec3& x = sphere.position;
        if (!sphere.mobile || !spec.walls[number].touches(spec.species[species])) continue;
        if (spec.domain.outside(x)) continue;  // it is refused for that
        touches.clear();
        wall.find(0, wall.image().of(x), sphere.radius, touches);
        for (const dem::WallTouch& touch : touches) {
            const double share = (sphere.radius - touch.place.distance) / (2 * sphere.radius);
            require(share <= deepest_at_start,
                    spec.species[species].name +
                        sentence(": a sphere at (%.4g, %.4g, %.4g) m starts", x[0], x[1], x[2]) +
                        sentence(" %.3g diameters deep (limit %.3g) in wall '", share, deepest_at_start) +
                        spec.walls[number].name + "'");
        }
    }
}

}  // namespace

void require_packing(std::string_view csv) {
    (void)particles::read_packing(csv, std::numeric_limits<double>::infinity());
}

void require_out_of_walls(const Spec& spec) {
    constexpr std::size_t many = 100;  // spheres for which walls are prepared
    const auto walls = walls_in(spec, 0, {{0.0}, {}});
    for (const auto& placed : of_kind<std::vector<Placed>>(spec.fills)) {
        double largest = 0;
        for (const Placed& one : placed)
            largest = std::max(largest, one.sphere.radius * spec.species[one.species].girth());
        for (std::size_t w = 0; w < walls.size(); ++w) {
            if (!walls[w].present) continue;
            using Searches = dem::MovingWall::Searches;
            dem::MovingWall wall(walls[w], spec.domain, largest, placed.size() > many ? Searches::many : Searches::few);
            wall.place(0);
            require_out_of_wall(spec, w, wall, placed);
        }
    }
}

void Filled::add(const Spec& spec, std::size_t of, const dem::Sphere& given, const geometry::Quaternion& orientation) {
    const Species& s = spec.species[of];
    dem::Sphere sphere = given;
    sphere.kind = s.material;
    if (!s.shape) {
        spheres.push_back(sphere);
        species.push_back(static_cast<std::uint8_t>(of));
        return;
    }
    const dem::Body body{.shape = shape_number(spec, of),
                         .scale = 2 * sphere.radius,
                         .first = spheres.size(),
                         .position = sphere.position,
                         .orientation = geometry::normalised(geometry::product(orientation, s.shape->turn)),
                         .velocity = sphere.velocity,
                         .angular_velocity = sphere.angular_velocity};
    for (dem::Sphere member : dem::members_of(body_shape(spec, s), body, sphere.kind)) {
        member.mobile = sphere.mobile;
        if (!sphere.mobile) member.velocity = member.angular_velocity = Vec3{};
        spheres.push_back(member);
        species.push_back(static_cast<std::uint8_t>(of));
    }
    if (sphere.mobile) bodies.push_back(body);
}

Draws::Draws(const Spec& spec, const Mix& mix, std::uint64_t seed, std::uint64_t number)
    : spec_(spec), mix_(mix), seed_(seed), number_(number) {}

double Draws::uniform(std::uint64_t purpose, std::uint64_t counter) const {
    return stats::to_unit(stats::bits_at(seed_, number_ * draws_of_one + purpose, counter));
}

std::vector<geometry::Ball> balls_of(const Spec& spec, const Draws::Particle& particle, const Vec3& centre,
                                     const geometry::Quaternion& orientation) {
    using namespace geometry;
    const Species& species = spec.species[particle.species];
    if (!species.shape) return {{centre, particle.radius}};
    const auto turn = product(orientation, species.shape->turn);
    const double diameter = 2 * particle.radius;
    std::vector<Ball> balls;
    for (const Ball& ball : species.shape->balls)
        balls.push_back({centre + diameter * turned(turn, ball.centre), diameter * ball.radius});
    return balls;
}

geometry::Quaternion Draws::orientation(std::size_t species, std::uint64_t n) const {
    if (!spec_.species[species].shape) return {1, 0, 0, 0};
    const auto number = [&](std::uint64_t k) {
        return stats::to_unit(stats::bits_at(seed_, first_orientations + number_, 3 * n + k));
    };
    return geometry::orientation_at(number(0), number(1), number(2));
}

double Draws::radius_of(std::size_t species, std::uint64_t n) const {
    const Species& s = spec_.species[species];
    return s.diameter / 2 * (s.sizes.equal() ? 1 : s.sizes.diameter(uniform(size_draw, n)));
}

Draws::Particle Draws::of_feed(std::uint64_t n) const {
    // Multiples of the golden ratio, shifted by the seed: every stretch of them has the shares within a particle or
    // two.
    double u = mix_.size() > 1 ? uniform(species_draw, 0) + golden * static_cast<double>(n) : 0;
    u -= std::floor(u);
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

std::vector<Draws::Particle> Draws::to_volume(double wanted) const {
    std::vector<Particle> particles;
    double volume = 0;
    for (std::uint64_t n = 0;; ++n) {
        const Particle next = of_feed(n);
        const double with = volume + particles::sphere_volume(2 * next.radius);
        if (!particles.empty() && with - wanted > wanted - volume) return particles;
        volume = with;
        particles.push_back(next);
    }
}

bool touches(const Spec& spec, const MachineWall& wall, const Mix& mix) {
    return std::ranges::any_of(
        mix, [&](const auto& part) { return part.second > 0 && wall.touches(spec.species[part.first]); });
}

Obstacles::Obstacles(const Spec& spec, const Mix& mix, const std::vector<dem::Wall>& walls, double largest, double time,
                     dem::MovingWall::Searches searches) {
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (!walls[w].present || !touches(spec, spec.walls[w], mix)) continue;
        walls_.emplace_back(walls[w], spec.domain, largest, searches);
        walls_.back().place(time);
        numbers_.push_back(w);
    }
}

std::optional<std::size_t> Obstacles::touched(const Vec3& centre, double radius) const {
    std::vector<dem::WallTouch> touches;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        walls_[w].find(0, centre, radius, touches);
        if (!touches.empty()) return numbers_[w];
    }
    return std::nullopt;
}

Filled filled(const Spec& spec, std::uint64_t seed, Artefacts* artefacts) {
    Filled all;
    Filler filler(spec, seed, artefacts, all);
    filler.fill();
    filler.require_apart();
    return all;
}

Filled filled_later(const Spec& spec, std::uint64_t seed, std::size_t phase, const dem::State& present,
                    const std::vector<dem::Wall>& walls, double time) {
    Filled all;
    Filler filler(spec, seed, nullptr, all);
    filler.continue_at(phase, present, walls, time);
    filler.fill();
    filler.require_apart_from_present();
    return all;
}

}  // namespace grainsweep::machine
