#include "solver/machine/plan.hpp"

#include "solver/dem/walls/moving_wall.hpp"
#include "solver/geometry/loose_parts.hpp"
#include "solver/machine/frames.hpp"
#include "solver/machine/grain_shapes.hpp"
#include "solver/machine/placing.hpp"
#include "solver/machine/setup.hpp"
#include "solver/machine/shapes.hpp"
#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

namespace grainsweep::machine {
namespace {

using kit::sentence;

constexpr double early = 0.5;  // of a phase that may end before its time
// s per particle and step with a probe at every step, by precision, and with another one.
constexpr double at_steps_mixed = 2.8e-7, at_steps_double = 1.6e-7, another = 1.3e-8;
constexpr double still_mesh = 1.2, moving_mesh = 1.7;  // cost of a step with them
constexpr double still_there = 0.3;                    // of the particles in a region, once some are taken away
constexpr double softest = 0.1;                        // overlap over diameter
constexpr double most_loose = 0.35;                    // solid fraction of particles placed at random
constexpr double most_on_lattice = 0.345, most_packed = 0.62, most_rain = 0.16;  // of fillings
constexpr double longest_way = 0.05;     // of a wall in a time step, smallest diameters
constexpr double steps_per_period = 20;  // of a vibration
constexpr double rare_part = 0.1;        // of the volume of a powder
constexpr double fewest_of_part = 3;     // spheres that hold it
// Pressed beds: their packing fraction and contacts of a grain; frequency of the network divided by sqrt(S/m) of the
// mean contact, and by that of the fastest one (measured at 20 and 60 kPa: 4.5 and 4.4, 2.5 and 2.6).
constexpr double pressed_fraction = 0.6, pressed_contacts = 6, over_mean = 4.5, over_fastest = 2.5;

/// Returns the cost of a step of a particle divided by a sphere's.
double cost_of(const Species& species) {
    return species.shape ? cost_of_clump(species.shape->balls.size()) : 1;
}

double mean_mass(const Spec& spec, const Mix& mix) {
    double mass = 0;
    for (const auto& [species, share] : mix)
        mass += share * spec.species[species].mean_volume() * spec.species[species].density(spec.densities);
    return mass;
}

double mean_volume(const Spec& spec, const Mix& mix) {
    double volume = 0;
    for (const auto& [species, share] : mix) volume += share * spec.species[species].mean_volume();
    return volume;
}

/// Returns the same of a mean particle.
double cost_in(const Spec& spec, const Mix& mix) {
    double cost = 0;
    for (const auto& [species, share] : mix) cost += share * cost_of(spec.species[species]);
    return cost;
}

double duration_of(const Spec& spec, const Phases& during) {
    double seconds = 0;
    for (std::size_t p = 0; p < spec.phases.size(); ++p)
        if (holds(during, p)) seconds += length_of(spec.phases[p]);
    return seconds;
}

/// Returns the expected number of spheres of a cut, from a grid of points.
double count_of(const Spec& spec, const Cut& cut) {
    constexpr int grid = 20;
    int inside = 0;
    const auto place = [&](int k) { return cut.edge * (k % grid + 0.5) / grid; };
    for (int k = 0; k < grid * grid * grid; ++k)
        inside += cut.in.contains({place(k), place(k / grid), place(k / grid / grid)}) ? 1 : 0;
    const double edge = cut.edge / spec.species[cut.species].diameter;
    const double all = cut.centres.empty() ? cut.fraction * 6 / std::numbers::pi * std::pow(edge, 3)
                                           : static_cast<double>(std::ranges::count(cut.centres, '\n')) - 1;
    return all * inside / std::pow(grid, 3);
}

/// Returns the number of spheres that would cost as much as the particles at the start.
double spheres_at_start(const Spec& spec) {
    double count = 0;
    for (const auto& fill : spec.fills) {
        if (const auto* region = std::get_if<Fill>(&fill))
            count +=
                region->glued || region->at > 0 ? 0 : static_cast<double>(region->count) * cost_in(spec, region->mix);
        else if (const auto* cut = std::get_if<Cut>(&fill))
            count += cut->glued ? 0 : count_of(spec, *cut);
        else
            for (const Placed& one : std::get<std::vector<Placed>>(fill)) count += cost_of(spec.species[one.species]);
    }
    return count;
}

/// Particles of a species at the start, or fed.
double count_of(const Spec& spec, const Species& species) {
    double count = 0;
    const auto share_in = [&](const Mix& mix) {
        double share = 0;
        for (const auto& [number, part] : mix) share += &spec.species[number] == &species ? part : 0;
        return share;
    };
    for (const Fill& fill : of_kind<Fill>(spec.fills)) count += static_cast<double>(fill.count) * share_in(fill.mix);
    for (const Feed& feed : spec.feeds)
        count += feed.rate * duration_of(spec, feed.during) / mean_mass(spec, feed.mix) * share_in(feed.mix);
    return count;
}

/// Returns the height of a filling along gravity, m: the height of its region, or the height that its particles need
/// when packed loosely.
double height_of(const Spec& spec, const Fill& fill) {
    const double g = geometry::norm(spec.gravity);
    if (!(g > 0)) return 0;
    const auto [low, high] = bounds_in(spec, fill.in);
    double height = 0;
    for (std::size_t k = 0; k < 3; ++k) height += (high[k] - low[k]) * std::abs(spec.gravity[k]) / g;
    const auto volume = fill.in.volume();
    const double solid = static_cast<double>(fill.count) * mean_volume(spec, fill.mix);
    return fill.as == Fill::As::random || !volume ? height
                                                  : height * std::min(1.0, solid / (most_on_lattice * *volume));
}

/// Returns the fastest fall of filled or fed particles, m/s. Faster impacts of walls are visible in max_overlap.
double fastest_fall(const Spec& spec) {
    const double g = geometry::norm(spec.gravity);
    double fastest = 0;
    for (const Fill& fill : of_kind<Fill>(spec.fills))
        if (!fill.glued)
            fastest = std::max(fastest, std::sqrt(2 * g * height_of(spec, fill)) + geometry::norm(fill.velocity));
    return spec.feeds.empty() ? fastest : std::max(fastest, fastest_of(spec));
}

void warn_of_softness(const Spec& spec, std::vector<Warning>& warnings) {
    const double speed = fastest_fall(spec);
    for (const Species& species : spec.species) {
        dem::Material material = spec.pairs[dem::place_of_pair(species.material, species.material)];
        material.density = spec.densities[species.material];
        const double overlap = kit::impact_overlap(material, species.largest(), speed);
        if (overlap <= softest) continue;
        warnings.push_back({"particles too soft for the fall",
                            species.name + sentence(": at %.3g m/s, the fastest impact expected, particles of this "
                                                    "stiffness overlap by about %.2g of a diameter, and contact laws "
                                                    "hold for small overlaps: raise youngs_modulus",
                                                    speed, overlap)});
        return;
    }
}

void warn_of_feeds(const Spec& spec, std::vector<Warning>& warnings) {
    for (const Feed& feed : spec.feeds) {
        const auto volume = feed.through.volume();
        if (!volume) continue;
        const double count = feed.rate * feed.interval / mean_mass(spec, feed.mix);
        const double solid = count * mean_volume(spec, feed.mix) / *volume;
        if (solid > most_loose)
            warnings.push_back(
                {"a feed that cannot keep up",
                 feed.name + sentence(": a batch would fill %.2g of its region with spheres, and at most "
                                      "%.2g find a place: enlarge the region, or raise its velocity",
                                      solid, most_loose)});
    }
}

void warn_of_falling(const Spec& spec, std::vector<Warning>& warnings) {
    const double g = geometry::norm(spec.gravity);
    const Phase& first = spec.phases.front();
    if (!(g > 0) || spec.phases.size() < 2 || !first.until.empty()) return;
    for (const Fill& fill : of_kind<Fill>(spec.fills)) {
        if (fill.glued || fill.at > 0 || fill.as == Fill::As::packed) continue;
        const double fall = std::sqrt(2 * height_of(spec, fill) / g);
        if (first.duration >= fall) continue;
        warnings.push_back({"powder still falling",
                            first.name + sentence(" lasts %.3g s and ends before a particle has fallen the height of "
                                                  "the loose filling, in %.3g s",
                                                  first.duration, fall)});
        return;
    }
}

void warn_of_fillings(const Spec& spec, std::vector<Warning>& warnings) {
    for (const Fill& fill : of_kind<Fill>(spec.fills)) {
        const auto volume = fill.in.volume();
        if (!volume) continue;
        const double most = fill.as == Fill::As::packed  ? most_packed
                            : fill.as == Fill::As::rain  ? most_rain
                            : fill.as == Fill::As::cells ? std::numbers::pi / 6 / std::pow(fill.spacing, 3)
                                                         : most_on_lattice;
        const double solid = static_cast<double>(fill.count) * mean_volume(spec, fill.mix) / *volume;
        if (solid > most && !fill.glued)
            warnings.push_back({"a filling that does not fit",
                                spec.species[fill.mix.front().first].name +
                                    sentence(": the region holds at most about %.3g particles filled in this way, and "
                                             "the filling has %.3g: enlarge the region or take fewer",
                                             std::floor(most / solid * static_cast<double>(fill.count)),
                                             static_cast<double>(fill.count))});
    }
}

/// Returns whether no particle can lie in a region that does not move: the region lies outside of the domain, or its
/// parts exclude each other.
bool stays_empty(const Spec& spec, Region region) {
    bool moves = false;
    region.each_moving([&](Region::Moving&) { moves = true; });
    const Bounds bounds = region.bounds();
    for (std::size_t k = 0; k < 3; ++k)
        if (!moves &&
            (bounds.low[k] > bounds.high[k] || (!spec.domain.periodic[k] && (bounds.low[k] > spec.domain.high[k] ||
                                                                             bounds.high[k] < spec.domain.low[k]))))
            return true;
    return false;
}

void warn_of_empty_regions(const Spec& spec, std::vector<Warning>& warnings) {
    std::string where;
    const auto add = [&](const std::string& name) { where += (where.empty() ? "" : ", ") + name; };
    for (const Measure& measure : spec.measures) {
        const auto& options = measure.options.all();
        if (std::ranges::any_of(options, [&](const auto& option) {
                const auto* region = std::get_if<Region>(&option.second);
                return region != nullptr && stays_empty(spec, *region);
            }))
            add(measure.name);
    }
    for (const Removal& removal : spec.removals)
        if (stays_empty(spec, removal.in)) add("remove at " + spec.phases[removal.at].name);
    if (!where.empty())
        warnings.push_back({"a region without particles",
                            where + ": the region lies outside of the domain, or its parts exclude each other, so that "
                                    "no particle is ever in it"});
}

void warn_of_walls(const Spec& spec, std::vector<Warning>& warnings) {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (const Species& species : spec.species)
        smallest = std::min(smallest, species.finest()), largest = std::max(largest, species.widest());
    for (const MachineWall& wall : spec.walls) {
        std::vector<geometry::Motion> motions;
        for (const WallMotion& motion : wall.motions) motions.push_back(motion.motion);
        if (motions.empty()) continue;
        const dem::MovingWall moving(dem::Wall(wall.shape, motions), spec.domain, largest,
                                     dem::MovingWall::Searches::few);
        const double speed = moving.fastest_surface();
        if (speed * spec.time_step > longest_way * smallest)
            warnings.push_back({"walls faster than the time step allows",
                                wall.name + sentence(" moves at up to %.3g m/s, %.2g of the smallest diameter in a "
                                                     "time step of %.3g s: take a shorter one",
                                                     speed, speed * spec.time_step / smallest, spec.time_step)});
        for (const auto& motion : motions)
            if (const auto* shaken = std::get_if<geometry::Vibration>(&motion);
                shaken != nullptr && shaken->frequency * spec.time_step > 1 / steps_per_period)
                warnings.push_back({"vibration faster than the time step",
                                    wall.name + sentence(": a period of %.3g s has %.2g time steps, and at least "
                                                         "%.0f follow it",
                                                         1 / shaken->frequency,
                                                         1 / (shaken->frequency * spec.time_step), steps_per_period)});
    }
}

/// A corner of a file that is far from its place draws its triangles out to a needle.
void warn_of_needles(const Spec& spec, std::vector<Warning>& warnings) {
    using geometry::End;
    const std::pair<End, const char*> ends[] = {
        {{2, false}, "lowest"}, {{0, true}, "foremost"}, {{0, false}, "rearmost"}};
    for (const MachineWall& wall : spec.walls) {
        const auto* mesh = std::get_if<geometry::Mesh>(&wall.shape);
        if (mesh == nullptr || !wall.fitted) continue;
        for (const auto& [end, name] : ends)
            if (const auto needle = geometry::needle_at(*mesh, end, small_share))
                warnings.push_back(
                    {"tip of the tool",
                     wall.name + ": the " + name +
                         sentence(
                             " point of the surface is the tip of a needle, %.3g m long and %.3g m thick, %.3g m along "
                             "y: if it is no part of it, remove it from the file",
                             needle->length, needle->width, needle->tip[1])});
    }
}

/// Returns the share by number of the largest spheres that hold `rare_part` of the volume: E[d^3; u > 1 - s] summed
/// over s.
double share_of_largest(const particles::SizeDistribution& sizes) {
    constexpr double finest = 1e-9;  // share by number from which the volume is summed
    constexpr double growth = 1.02;  // from one share to the next
    const double whole = sizes.moment(3);
    double held = 0, above = 0;
    for (double share = finest; share < 1; share *= growth) {
        held += std::pow(sizes.diameter(1 - (above + share) / 2), 3) * (share - above);
        above = share;
        if (held >= rare_part * whole) return share;
    }
    return 1;
}

/// Warns of species of which fewer than three spheres are expected among the largest sizes with a tenth of the volume.
void warn_of_rare_sizes(const Spec& spec, std::vector<Warning>& warnings) {
    for (const Species& species : spec.species) {
        const double count = count_of(spec, species);
        if (species.sizes.equal() || count <= 0) continue;
        const double share = share_of_largest(species.sizes);
        if (share * count >= fewest_of_part) continue;
        warnings.push_back(
            {"sizes too rare for the number of particles",
             sentence("spheres above %.3g m hold a tenth of the volume, and %.3g of %.0f particles are so "
                      "large on average: the case cannot represent the distribution, take more particles",
                      species.sizes.diameter(1 - share) * species.diameter, share * count, count)});
    }
}

/// Volume of all particles at the start and of all that are fed, m3.
double volume_of_powder(const Spec& spec) {
    double volume = 0;
    for (const auto& fill : spec.fills) {
        if (const auto* region = std::get_if<Fill>(&fill))
            volume += static_cast<double>(region->count) * mean_volume(spec, region->mix);
        if (const auto* placed = std::get_if<std::vector<Placed>>(&fill))
            for (const Placed& one : *placed) volume += spec.species[one.species].mean_volume();
    }
    for (const Feed& feed : spec.feeds)
        volume += feed.rate * duration_of(spec, feed.during) * mean_volume(spec, feed.mix) / mean_mass(spec, feed.mix);
    return volume;
}

/// Warns of walls that are far larger than the powder, as an STL file in mm that is read in m.
void warn_of_scale(const Spec& spec, std::vector<Warning>& warnings) {
    constexpr double far_larger = 300, many_diameters = 3000;
    double largest = 0;
    for (const Species& species : spec.species) largest = std::max(largest, species.largest());
    const double bed = std::cbrt(volume_of_powder(spec));
    for (const MachineWall& wall : spec.walls) {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto extent = std::visit([k](const auto& shape) { return shape.extent(k); }, wall.shape);
            if (extent.bounded()) longest = std::max(longest, extent.high - extent.low);
        }
        if (bed > 0 && longest > far_larger * bed && longest > many_diameters * largest)
            warnings.push_back(
                {"a wall far larger than the powder",
                 wall.name + sentence(" is %.3g m long, and the powder would fill a cube of %.2g m: ", longest, bed) +
                     (std::holds_alternative<geometry::Mesh>(wall.shape) ? "an STL file in mm needs \"scale\": \"1 mm\""
                                                                         : "numbers without a unit are in m")});
    }
}

/// Warns of positions in mixed precision that are too coarse for overlaps.
void warn_of_wide_domain(const Spec& spec, std::vector<Warning>& warnings) {
    constexpr double coarse = 1e-3;  // diameters
    if (spec.method.precision != dem::Method::Precision::mixed) return;
    double longest = 0, smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, spec.domain.length(k));
    for (const Species& species : spec.species) smallest = std::min(smallest, species.finest());
    const double unit = longest / 0x1p32;
    if (unit > coarse * smallest)
        warnings.push_back(
            {"a domain too wide for mixed precision",
             sentence(
                 "in mixed precision positions are multiples of %.2g m, %.2g of the smallest diameter, in a domain "
                 "%.3g m long: make it smaller, or take precision \"double\"",
                 unit, unit / smallest, longest)});
}

/// Warns of phases that wait for rest or for the end of a flow while walls move or particles are fed.
void warn_of_phases(const Spec& spec, std::vector<Warning>& warnings) {
    for (std::size_t p = 0; p < spec.phases.size(); ++p) {
        const Phase& phase = spec.phases[p];
        const bool waits = std::ranges::all_of(phase.until, [](const Until& until) {
            return std::holds_alternative<AtRest>(until) || std::holds_alternative<FlowStops>(until) ||
                   std::holds_alternative<Empty>(until) || std::holds_alternative<Quiet>(until);
        });
        if (phase.until.empty() || !waits) continue;
        const auto feed =
            std::ranges::find_if(spec.feeds, [&](const Feed& one) { return one.rate > 0 && holds(one.during, p); });
        if (feed == spec.feeds.end()) continue;
        warnings.push_back(
            {"a phase that cannot end before its time",
             phase.name + ": it ends when nothing moves or is left, and " + feed->name + " adds particles meanwhile"});
    }
}

/// Returns the width of the powder across a direction, m2: the largest of the fillings.
double area_across(const Spec& spec, const Vec3& along) {
    double largest = 0;
    for (const Fill& fill : of_kind<Fill>(spec.fills)) {
        const auto [low, high] = bounds_in(spec, fill.in);
        const Vec3 size = geometry::operator-(high, low);
        const double area = std::abs(along[0]) * size[1] * size[2] + std::abs(along[1]) * size[0] * size[2] +
                            std::abs(along[2]) * size[0] * size[1];
        largest = std::max(largest, area);
    }
    return largest;
}

/// Returns the number of parts of a time step (dem/step_control.hpp) in a bed of a species under a stress, Pa. The mean
/// force of a contact is 4 pi R^2 stress/(fraction contacts) (Rumpf 1958).
double parts_under(const Spec& spec, const Species& species, double stress) {
    const dem::Material m = spec.pairs[dem::place_of_pair(species.material, species.material)];
    const double radius = species.smallest() / 2, mass = dem::sphere_mass(radius, spec.densities[species.material]);
    const double force = 4 * std::numbers::pi * radius * radius * stress / (pressed_fraction * pressed_contacts);
    const double slope =
        m.normal_law == dem::NormalLaw::linear
            ? m.stiffness
            : std::cbrt(6 * dem::effective_modulus(m) * dem::effective_modulus(m) * (radius / 2) * force);
    const double phase = over_mean * std::sqrt(slope / mass) * spec.time_step;
    const double damping = dem::damping_factor(m.restitution) / 2 * over_fastest;
    const double share = phase / (2 * (std::hypot(1, damping) - damping));
    double parts = 1;
    while (share / parts > *spec.step_share && parts < 64) parts *= 2;
    return parts;
}

/// Returns the mean number of parts of a step, over all phases.
double mean_parts(const Spec& spec) {
    if (!spec.step_share) return 1;
    double all = 0, sum = 0;
    for (std::size_t p = 0; p < spec.phases.size(); ++p) {
        double parts = 1;
        for (const MachineWall& wall : spec.walls)
            for (const WallMotion& motion : wall.motions) {
                const auto* press = std::get_if<geometry::Press>(&motion.motion);
                const double area = press != nullptr ? area_across(spec, press->along) : 0;
                if (!(area > 0) || (motion.phases && (p < motion.phases->first || p > motion.phases->last))) continue;
                for (const Species& species : spec.species)
                    parts = std::max(
                        parts, parts_under(spec, species, geometry::largest_load(press->force, press->course) / area));
            }
        all += length_of(spec.phases[p]);
        sum += parts * length_of(spec.phases[p]);
    }
    return all > 0 ? sum / all : 1;
}

/// Returns the time in which probes read the contacts of every step, s per particle.
double cost_of_step_probes(const Spec& spec) {
    const bool mixed = spec.method.precision == dem::Method::Precision::mixed;
    const double one = mixed ? at_steps_mixed : at_steps_double;
    double seconds = 0;
    for (std::size_t p = 0; p < spec.phases.size(); ++p) {
        const auto probes = std::ranges::count_if(spec.measures, [&](const Measure& measure) {
            return holds(measure.during, p) && find_probe(measure.probe)->source == Source::steps;
        });
        if (probes == 0) continue;
        const double steps = length_of(spec.phases[p]) / spec.time_step;
        seconds += steps * (one + another * static_cast<double>(probes - 1));
    }
    return seconds;
}

/// How much longer a step takes with walls of triangles: as in blender, screw feeder and silo.
double cost_of_meshes(const Spec& spec) {
    double factor = 1;
    for (const MachineWall& wall : spec.walls)
        if (std::holds_alternative<geometry::Mesh>(wall.shape))
            factor = std::max(factor, wall.motions.empty() ? still_mesh : moving_mesh);
    return factor;
}

/// Seconds from the beginning of a phase to the beginning of another one.
double seconds_between(const Spec& spec, std::size_t from, std::size_t to) {
    double seconds = 0;
    for (std::size_t p = from; p < to; ++p) seconds += length_of(spec.phases[p]);
    return seconds;
}

/// Adds what particles cost that are filled later or taken away.
void add_later(const Spec& spec, double& work, double& most) {
    for (const Fill& fill : of_kind<Fill>(spec.fills)) {
        if (fill.glued) continue;
        const double spheres = static_cast<double>(fill.count) * cost_in(spec, fill.mix);
        std::size_t taken = spec.phases.size();
        for (const Removal& removal : spec.removals)
            if (removal.at > fill.at) taken = std::min(taken, removal.at);
        const double gone = (1 - still_there) * seconds_between(spec, taken, spec.phases.size());
        if (fill.at > 0) {
            work += spheres * seconds_between(spec, fill.at, spec.phases.size());
            most += taken < spec.phases.size() ? still_there * spheres : spheres;
        }
        work -= spheres * gone;
    }
}

double frozen_of(const Spec& spec) {
    double count = 0;
    for (const Fill& fill : of_kind<Fill>(spec.fills))
        if (fill.glued) count += static_cast<double>(fill.count);
    return count;
}

}  // namespace

double length_of(const Phase& phase) {
    if (phase.until.empty()) return phase.duration;
    return std::min(phase.duration, phase.expected.value_or(early * phase.duration));
}

CostEstimate cost_of(const Spec& spec) {
    require_places(spec);
    double work = 0, most = spheres_at_start(spec);
    work += most * duration_of(spec, {});
    add_later(spec, work, most);
    for (const Feed& feed : spec.feeds) {
        // A fed particle stays for half of the time, in the mean.
        const double fed =
            feed.rate * duration_of(spec, feed.during) / mean_mass(spec, feed.mix) * cost_in(spec, feed.mix);
        work += fed * duration_of(spec, feed.during) / 2;
        most += fed;
    }
    const double steps = duration_of(spec, {}) / spec.time_step;
    auto cost = kit::estimate(
        spec.method, spec.pairs.front(), most,
        mean_parts(spec) * cost_of_meshes(spec) * (most > 0 ? work / spec.time_step / most : steps), frozen_of(spec));
    cost.seconds += most * cost_of_step_probes(spec);
    return cost;
}

void warn_of_frames(const Spec& spec, std::vector<Warning>& warnings) {
    if (const std::string flaw = flaw_of_frames(spec); !flaw.empty())
        warnings.push_back({"frames in step with a motion", flaw});
}

std::vector<Warning> warnings_of(const Spec& spec) {
    std::vector<Warning> warnings = spec.warnings;
    warn_of_softness(spec, warnings);
    warn_of_fillings(spec, warnings);
    warn_of_empty_regions(spec, warnings);
    warn_of_falling(spec, warnings);
    warn_of_feeds(spec, warnings);
    warn_of_walls(spec, warnings);
    warn_of_scale(spec, warnings);
    warn_of_wide_domain(spec, warnings);
    warn_of_needles(spec, warnings);
    warn_of_phases(spec, warnings);
    warn_of_frames(spec, warnings);
    std::set<std::string> kinds;
    std::erase_if(warnings, [&](const Warning& warning) { return !kinds.insert(warning.kind).second; });
    warn_of_rare_sizes(spec, warnings);
    return warnings;
}

}  // namespace grainsweep::machine
