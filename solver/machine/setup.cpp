#include "solver/machine/setup.hpp"

#include "solver/machine/probe.hpp"
#include "solver/machine/reduction.hpp"

#include "solver/dem/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace grainsweep::machine {
namespace {

using geometry::dot;
using geometry::Motion;
using geometry::norm;
using geometry::operator-;
using geometry::operator+;
using geometry::operator*;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double deepest_in_walls = 0.45;  // diameters; particles pinched between walls do not end the run
constexpr int poses = 400;                 // of a moving wall at which its extent is taken
constexpr double margin = 2;               // largest diameters around the walls

/// The motion as it acts where some phases have begun; none while its first one has not.
std::optional<Motion> acting(const WallMotion& given, const PhaseTimes& times) {
    Motion motion = given.motion;
    if (!given.phases) return motion;
    if (given.phases->first >= times.begin.size()) return std::nullopt;
    const double start = times.begin[given.phases->first];
    const double end = given.phases->last < times.end.size() ? times.end[given.phases->last] : never;
    std::visit([&](auto& m) { m.start = start, m.end = end; }, motion);
    return motion;
}

double widest_of(const Spec& spec) {
    double largest = 0;
    for (const Species& species : spec.species) largest = std::max(largest, species.widest());
    return largest;
}

/// Widens a box by the ends of another one that are finite.
void widen_by_ends(Bounds& all, const Bounds& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (std::isfinite(other.low[k])) all.low[k] = std::min(all.low[k], other.low[k]);
        if (std::isfinite(other.high[k])) all.high[k] = std::max(all.high[k], other.high[k]);
    }
}

/// The corners of a wall's extent, at poses of all times up to the end of the last phase.
void widen_by(Bounds& all, const MachineWall& wall, const std::vector<Phase>& phases) {
    PhaseTimes times;
    double end = 0;
    for (const Phase& phase : phases) {
        times.begin.push_back(end);
        times.end.push_back(end += phase.duration);
    }
    std::vector<Motion> motions;
    for (const WallMotion& motion : wall.motions)
        if (auto act = acting(motion, times)) motions.push_back(*act);
    Bounds body;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto extent = std::visit([&](const auto& shape) { return shape.extent(k); }, wall.shape);
        body.low[k] = extent.low, body.high[k] = extent.high;
    }
    const bool turns = std::ranges::any_of(motions, geometry::turns);
    for (int n = 0; n <= (motions.empty() ? 0 : poses); ++n) {
        const auto pose = geometry::pose_at(motions, end * n / poses);
        for (std::size_t corner = 0; corner < 8; ++corner)
            if (const Vec3 x = body.corner(corner); geometry::finite(x)) all.widen(pose.from_body(x));
        // What is without end along an axis bounds the others, as long as it is not turned.
        if (!turns) widen_by_ends(all, {body.low + pose.shift, body.high + pose.shift});
    }
}

/// A plane across an axis bounds it.
void bound_by(Bounds& all, const geometry::Plane& plane) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(plane.normal[k]) == 1) {
            all.low[k] = std::min(all.low[k], plane.point[k]);
            all.high[k] = std::max(all.high[k], plane.point[k]);
        }
}

}  // namespace

bool holds(const Phases& phases, std::size_t phase) {
    return phases.empty() || std::ranges::find(phases, phase) != phases.end();
}

std::size_t MachineWall::times(std::size_t phase) const {
    if (!again) return 0;
    const auto begun = std::ranges::count_if(again->each, [phase](std::size_t p) { return p <= phase; });
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(begun, 1) - 1);
}

void each_region(Spec& spec, const std::function<void(Region&)>& visit) {
    for (Removal& removal : spec.removals) visit(removal.in);
    for (Measure& measure : spec.measures) measure.options.each_region(visit);
    for (Phase& phase : spec.phases)
        for (Until& until : phase.until)
            std::visit(
                [&](auto& condition) {
                    if constexpr (requires { condition.region; }) visit(condition.region);
                },
                until);
}

bool is_integrated(const Measure& measure) {
    return find_probe(measure.probe)->source == Source::loads &&
           find_reduction(measure.reduction)->of_intervals != nullptr;
}

std::vector<WhileIn> runs_of(const Spec& spec, const Measure& measure) {
    std::vector<WhileIn> runs;
    for (std::size_t p = 0; p < spec.phases.size(); ++p) {
        if (!holds(measure.during, p)) continue;
        if (!runs.empty() && runs.back().last + 1 == p)
            runs.back().last = p;
        else
            runs.push_back({p, p});
    }
    return runs;
}

Vec3 way_of(const dem::Wall& wall, const std::optional<Vec3>& along, double time) {
    std::vector<Motion> motions;
    std::ranges::remove_copy_if(wall.motions, std::back_inserter(motions), geometry::turns);
    const Vec3 way = geometry::pose_at(motions, time).shift;
    return along ? dot(way, *along) * *along : way;
}

static bool loads_are_integrated(const Spec& spec, std::size_t wall) {
    return std::ranges::any_of(spec.measures, [wall](const Measure& measure) {
        return is_integrated(measure) && std::ranges::count(measure.options.numbers("wall"), wall) > 0;
    });
}

/// Lets a motion begin no earlier than its wall starts anew, for the n-th time; a wall that the powder moves is then at
/// rest. Returns whether the motion acts from then on, or places the wall.
static bool starts_at(Motion& motion, double begun, std::size_t n) {
    constexpr double most_motions = 1e6;  // of a wall
    return std::visit(
        [&](auto& m) {
            if (m.end <= 0) return true;  // before the start
            if constexpr (requires { m.number; })
                if (m.start < begun) m.number += most_motions * static_cast<double>(n);
            m.start = std::max(m.start, begun);
            return m.end > begun;
        },
        motion);
}

/// Returns whether a wall is absent as long as the start lasts: no state of the start depends on it.
static bool joins_after_start(const Spec& spec, const MachineWall& wall) {
    for (std::size_t p = 0; p < spec.start.phases; ++p)
        if (wall.present(p)) return false;
    return true;
}

std::vector<dem::Wall> walls_in(const Spec& spec, std::size_t phase, const PhaseTimes& times, double zero) {
    std::vector<dem::Wall> walls;
    for (const MachineWall& given : spec.walls) {
        if (phase < spec.start.phases && joins_after_start(spec, given)) {
            dem::Wall absent(geometry::Plane{});
            absent.materials = given.materials;
            absent.present = false;
            walls.push_back(std::move(absent));
            continue;
        }
        dem::Wall wall(given.shape);
        const std::size_t again = given.times(phase);
        const double begun = again > 0 ? times.begin[given.again->each[again]] : 0;
        for (const WallMotion& motion : given.motions)
            if (auto act = acting(motion, times); act && (again == 0 || starts_at(*act, begun, again)))
                wall.motions.push_back(*act);
        if (again > 0)  // before the start it moves to its place
            wall.motions.push_back(geometry::Translation{static_cast<double>(again) * given.again->by, -1, 0});
        for (Motion& motion : wall.motions) std::visit([zero](auto& m) { m.start -= zero, m.end -= zero; }, motion);
        wall.materials = given.materials;
        wall.passing = given.passing;
        wall.present = given.present(phase);
        wall.integrated = loads_are_integrated(spec, walls.size());
        walls.push_back(std::move(wall));
    }
    return walls;
}

dem::BodyShape body_shape(const Spec& spec, const Species& species) {
    const double density = spec.densities[species.material];
    dem::BodyShape shape;
    for (const auto& ball : species.shape->balls) shape.members.push_back({ball.centre, ball.radius});
    shape.mass = density * species.shape->mass;
    shape.inertia = density * species.shape->inertia;
    shape.damping = species.damping_mass;
    return shape;
}

std::size_t shape_number(const Spec& spec, std::size_t species) {
    const auto has_shape = [](const Species& one) { return one.shape.has_value(); };
    return static_cast<std::size_t>(std::ranges::count_if(
        spec.species.begin(), spec.species.begin() + static_cast<std::ptrdiff_t>(species), has_shape));
}

dem::Setup setup_of(const Spec& spec, const Filled& filled) {
    dem::Setup setup;
    setup.domain = spec.domain;
    setup.material = spec.pairs.front();
    setup.material.density = spec.densities.front();
    if (spec.densities.size() > 1) setup.kinds = {spec.densities, spec.pairs};
    setup.gravity = spec.gravity;
    setup.shaking = spec.shaking;
    setup.frozen = spec.glued;
    setup.time_step = spec.time_step;
    setup.step_share = spec.step_share;
    setup.spheres = filled.spheres;
    setup.bodies = filled.bodies;
    for (const Species& species : spec.species)
        if (species.shape) setup.shapes.push_back(body_shape(spec, species));
    setup.deepest_in_walls = deepest_in_walls;
    setup.walls = walls_in(spec, 0, {{0.0}, {}});
    return setup;
}

/// Returns the density by which a sphere has the least mass that an impact on a particle feels, kg/m3.
static double impact_density(const Spec& spec, const Species& species) {
    return spec.densities[species.material] * (species.shape ? species.shape->lightness : 1);
}

double time_step_of(const Spec& spec, double fraction, double speed) {
    double shortest = never;
    const auto pair_of = [&](std::size_t a, std::size_t b) { return spec.pairs[dem::place_of_pair(a, b)]; };
    for (const Species& a : spec.species) {
        dem::Material own = pair_of(a.material, a.material);
        own.density = impact_density(spec, a);
        shortest = std::min(shortest, dem::shortest_time(own, a.finest() / 2, speed));
        for (const Species& b : spec.species) {
            dem::Material pair = pair_of(a.material, b.material);
            pair.density = std::min(impact_density(spec, a), impact_density(spec, b));
            shortest = std::min(shortest, dem::impact_limit(pair, std::min(a.finest(), b.finest()) / 2, speed));
        }
        for (const MachineWall& wall : spec.walls) {
            if (!wall.touches(a)) continue;
            dem::Material pair = wall.materials[a.material];
            pair.density = impact_density(spec, a);
            shortest = std::min(shortest, dem::impact_limit(pair, a.finest() / 2, speed));
        }
    }
    for (const MachineWall& wall : spec.walls)
        for (const WallMotion& motion : wall.motions)
            shortest = std::min(shortest, geometry::longest_step(motion.motion));
    return fraction * shortest;
}

void take_own_step(Spec& spec, double fraction, double longest) {
    spec.time_step = fraction * longest;
    spec.step_share = dem::step_share(fraction);
}

double fastest_of(const Spec& spec) {
    const double g = norm(spec.gravity);
    double top = 0, initial = 0;
    const auto consider = [&](const Region& region) {
        if (!(g > 0)) return;
        const Bounds bounds = region.bounds();
        for (std::size_t corner = 0; corner < 8; ++corner) {
            Vec3 x = bounds.corner(corner);
            for (std::size_t k = 0; k < 3; ++k) x[k] = std::clamp(x[k], spec.domain.low[k], spec.domain.high[k]);
            // Distance from there to the lower end of the domain.
            double drop = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double along = spec.gravity[k] / g;
                if (!spec.domain.periodic[k])
                    drop += std::max(along * (spec.domain.low[k] - x[k]), along * (spec.domain.high[k] - x[k]));
            }
            top = std::max(top, drop);
        }
    };
    for (const auto& fill : spec.fills) {
        if (const auto* region = std::get_if<Fill>(&fill)) {
            consider(region->in);
            initial = std::max(initial, norm(region->velocity) + region->shaken);
        } else if (const auto* cut = std::get_if<Cut>(&fill)) {
            if (!cut->glued) consider({Region::Box{{}, {cut->edge, cut->edge, cut->edge}}});
        } else {
            for (const Placed& placed : std::get<std::vector<Placed>>(fill)) {
                initial = std::max(initial, norm(placed.sphere.velocity));
                const Vec3& x = placed.sphere.position;
                consider({Region::Box{x, x}});
            }
        }
    }
    for (const Feed& feed : spec.feeds) {
        consider(feed.through);
        initial = std::max(initial, norm(feed.velocity));
    }
    double walls = 0;
    const double largest = widest_of(spec);
    for (const MachineWall& wall : spec.walls) {
        std::vector<Motion> motions;
        for (const WallMotion& motion : wall.motions) motions.push_back(motion.motion);
        if (motions.empty() && spec.domain.periodic == std::array<bool, 3>{}) continue;  // it cannot exceed a period
        try {
            const dem::MovingWall moving(dem::Wall(wall.shape, motions), spec.domain, largest,
                                         dem::MovingWall::Searches::few);
            walls = std::max(walls, moving.fastest());
        } catch (const std::invalid_argument& why) {
            throw std::invalid_argument("wall '" + wall.name + "': " + why.what());
        }
    }
    return std::max(std::sqrt(2 * g * top) + initial + walls, 1e-3);
}

geometry::Domain domain_around(const Spec& spec, const std::array<bool, 3>& given) {
    Bounds all = geometry::nowhere;
    for (const MachineWall& wall : spec.walls) {
        widen_by(all, wall, spec.phases);
        if (const auto* plane = std::get_if<geometry::Plane>(&wall.shape)) bound_by(all, *plane);
    }
    const auto include = [&](const Region& region) { widen_by_ends(all, region.bounds()); };
    for (const auto& fill : spec.fills) {
        if (const auto* region = std::get_if<Fill>(&fill)) include(region->in);
        if (const auto* placed = std::get_if<std::vector<Placed>>(&fill))
            for (const Placed& one : *placed) all.widen(one.sphere.position);
        if (const auto* cut = std::get_if<Cut>(&fill)) include({Region::Box{{}, {cut->edge, cut->edge, cut->edge}}});
    }
    for (const Feed& feed : spec.feeds) include(feed.through);
    geometry::Domain domain{all.low, all.high, {}};
    const double around = margin * widest_of(spec);
    for (std::size_t k = 0; k < 3; ++k) {
        if (given[k]) continue;
        if (!(std::isfinite(all.low[k]) && std::isfinite(all.high[k])))
            throw std::invalid_argument(std::string("nothing bounds the machine along ") + "xyz"[k] +
                                        ": give a \"domain\"");
        domain.low[k] -= around;
        domain.high[k] += around;
    }
    return domain;
}

}  // namespace grainsweep::machine
