// Places of a filling's particles.
#include "solver/machine/placing.hpp"

#include "solver/machine/neighbourhood.hpp"
#include "solver/machine/setup.hpp"

#include "solver/particles/packing.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace grainsweep::machine {
namespace {

using geometry::operator-;
using kit::require;
using kit::sentence;

constexpr double most_jitter = 0.05, lowest = 0.1;      // D
constexpr double spacing = 1.15, least_spacing = 1.02;  // D, largest diameters
constexpr double most_sites = 2e8;
constexpr double rain_layer = 1.05, rain_cover = 0.25;                    // largest diameters, share of the area
constexpr double packed_fraction = 0.62, least_edge = 6, most_edge = 16;  // diameters
constexpr std::uint64_t tries_by_members = 20000, tries_of_lower = 400;   // of one clump
constexpr double shrinkage = 0.98;          // of the box of these tries, from one to the next
constexpr std::int64_t most_tried = 20000;  // particles whose places are sought before a case runs
constexpr double rounding = 1e-9;           // of a radius: a layer one diameter thick holds spheres

/// Places of a lattice: their distance, and how far particles are off them in each direction, so that none touch.
struct Pitch {
    double distance = 0, jitter = 0, largest = 0;

    Pitch(const Spec& spec, const Mix& mix) : largest(widest_in(spec, mix)) {
        double diameter = 0;
        for (const auto& [species, share] : mix)
            if (share > 0)
                diameter = std::max(diameter, spec.species[species].diameter * spec.species[species].girth());
        distance = std::max(spacing * diameter, least_spacing * largest);
        jitter = std::min(most_jitter * diameter, (distance - largest) / 2);
    }
};

std::string name_of(const Spec& spec, const Mix& mix) {
    std::string names;
    for (const auto& [species, share] : mix) names += (names.empty() ? "" : " and ") + spec.species[species].name;
    return names;
}

bool has_shapes(const Spec& spec, const Fill& fill) {
    return std::ranges::any_of(fill.mix, [&](const auto& part) { return spec.species[part.first].shape.has_value(); });
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

/// Whether a sphere lies between the faces, periodic ones too: so that no image meets it.
bool lies_within(const Bounds& bounds, const Vec3& centre, double radius) {
    for (std::size_t k = 0; k < 3; ++k)
        if (centre[k] - radius < bounds.low[k] || centre[k] + radius > bounds.high[k]) return false;
    return true;
}

/// Returns the places of a lattice in the region, at most as many as are wanted.
std::vector<Vec3> sites_in(const Spec& spec, const Fill& fill, const Pitch& pitch, const Obstacles& obstacles) {
    const double room = pitch.largest / 2 + std::numbers::sqrt3 * pitch.jitter;
    const Bounds bounds = bounds_in(spec, fill.in);
    const Lattice lattice(bounds, periodic_in(spec, bounds), pitch.distance, room);
    require(lattice.sites() < most_sites,
            "the region of a filling has more than 2e8 places for particles: make it smaller");
    const auto wanted = static_cast<std::size_t>(fill.count);
    std::vector<Vec3> centres;
    lattice.each([&](const Vec3& site) {
        if (centres.size() == wanted) return false;
        if (fits(spec, obstacles, fill.in, site, room * (1 - rounding))) centres.push_back(site);
        return true;
    });
    return centres;
}

/// Throws if not one particle of a filling could find a place, from a grid of places: the region lies outside of the
/// domain, is too small, or a wall takes it up.
void require_some(const Spec& spec, const Fill& fill, const Obstacles& obstacles) {
    constexpr int tried = 20;  // places along each axis
    const Bounds bounds = bounds_in(spec, fill.in);
    const auto periodic = periodic_in(spec, bounds);
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& [species, share] : fill.mix)
        if (share > 0) smallest = std::min(smallest, spec.species[species].finest());
    const double room = smallest / 2 * (1 - rounding);
    const std::string name = name_of(spec, fill.mix) + ": the region of the filling ";
    for (std::size_t k = 0; k < 3; ++k) {
        const double width = bounds.high[k] - bounds.low[k];
        require(width > 0, name + "lies outside of the domain along " + "xyz"[k]);
        require(periodic[k] || width >= 2 * room,
                name + sentence("is %.3g m wide along ", width) + "xyz"[k] +
                    sentence(" in the domain, and the smallest particle %.3g m", smallest));
    }
    std::map<std::size_t, int> taken;  // places by wall
    for (int n = 0; n < tried * tried * tried; ++n) {
        const std::array<int, 3> cell = {n % tried, n / tried % tried, n / tried / tried};
        Vec3 centre{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double off = periodic[k] ? 0 : room, width = bounds.high[k] - bounds.low[k] - 2 * off;
            centre[k] = bounds.low[k] + off + (cell[k] + 0.5) / tried * width;
        }
        if (fill.in.depth(centre) < room) continue;
        const auto wall = obstacles.touched(centre, room);
        if (!wall) return;
        ++taken[*wall];
    }
    if (taken.empty()) return;  // a region of many parts may have places between
    const auto most = std::ranges::max_element(taken, {}, [](const auto& one) { return one.second; });
    require(false, name + "has no place for a particle: wall '" + spec.walls[most->first].name +
                       "' takes it up; move the region, or let the wall face the other way");
}

/// Throws unless all particles of a filling have a place.
void require_all(const Spec& spec, const Fill& fill, std::size_t places, const Obstacles& obstacles) {
    if (places == 0 && fill.count > 0) require_some(spec, fill, obstacles);
    const char* full =
        ": %.0f of %.0f particles fit into the region on a lattice of 1.15 diameters: make the region "
        "larger or the number smaller";
    if (fill.as == Fill::As::rain)
        full = ": rain of %.0f of %.0f particles fills the region up to its top: make it higher or wider";
    if (fill.as == Fill::As::packed)
        full =
            ": %.0f of %.0f particles fit into the region in a close packing: make the region larger or the number "
            "smaller";
    if (has_shapes(spec, fill))
        full = ": %.0f of %.0f particles find a place without overlap: make the region larger or the number smaller";
    require(places == static_cast<std::size_t>(fill.count),
            name_of(spec, fill.mix) + sentence(full, static_cast<double>(places), static_cast<double>(fill.count)));
}

std::vector<Vec3> on_lattice(const Spec& spec, const Fill& fill, const Draws& draws, const Obstacles& obstacles) {
    const Pitch pitch(spec, fill.mix);
    auto centres = sites_in(spec, fill, pitch, obstacles);
    for (std::size_t n = 0; n < centres.size(); ++n)
        for (std::size_t k = 0; k < 3; ++k)
            centres[n][k] += pitch.jitter * (2 * draws.uniform(place_draw, 3 * n + k) - 1);
    return centres;
}

/// One in each cell of a grid, layer by layer. Cells share the width of the bounds; upwards they are as high as needed.
/// Particles are off the middle by up to half of what the least cell leaves free.
std::vector<Vec3> in_cells(const Spec& spec, const Fill& fill, const Draws& draws, const Obstacles& obstacles) {
    const double largest = widest_in(spec, fill.mix), least = fill.spacing * largest;
    const Bounds bounds = fill.in.bounds();
    std::array<std::uint64_t, 3> count{};
    Vec3 step{}, shift{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = bounds.high[k] - bounds.low[k];
        require(length >= largest * (1 - rounding),
                name_of(spec, fill.mix) + ": the region is narrower than a particle");
        count[k] = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(length / least));
        step[k] = k < 2 ? length / static_cast<double>(count[k]) : std::min(length, least);
        shift[k] = std::clamp((step[k] - largest) / 2, 0.0, (fill.spacing - 1) / 2 * largest);
    }
    require(static_cast<double>(count[0]) * static_cast<double>(count[1]) * static_cast<double>(count[2]) < most_sites,
            "the region of a filling has more than 2e8 places for particles: make it smaller");
    const auto wanted = static_cast<std::size_t>(fill.count);
    std::vector<Vec3> centres;
    for (std::uint64_t cell = 0; centres.size() < wanted; ++cell) {
        const std::array<std::uint64_t, 3> site = {cell % count[0], cell / count[0] % count[1],
                                                   cell / count[0] / count[1]};
        require(site[2] < count[2],
                name_of(spec, fill.mix) + sentence(": %.0f of %.0f particles fit into the cells of the region: make it "
                                                   "larger or the number smaller",
                                                   static_cast<double>(centres.size()), static_cast<double>(wanted)));
        Vec3 middle{}, centre{};
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = bounds.low[k] + (static_cast<double>(site[k]) + 0.5) * step[k];
            centre[k] = middle[k] + shift[k] * (2 * draws.uniform(place_draw, 3 * centres.size() + k) - 1);
        }
        if (fill.in.depth(middle) < largest / 2 * (1 - rounding)) continue;
        if (fill.glued || !obstacles.touch(centre, largest / 2)) centres.push_back(centre);
    }
    return centres;
}

std::vector<Vec3> at_random(const Spec& spec, const Fill& fill, const Draws& draws,
                            const std::vector<Draws::Particle>& particles, const Obstacles& obstacles) {
    std::vector<double> radii;
    for (const auto& particle : particles) radii.push_back(particle.radius);
    const Bounds bounds = bounds_in(spec, fill.in);
    const particles::Room room{bounds.low, bounds.high, periodic_in(spec, bounds),
                               [&](const Vec3& centre, double radius) {
                                   return fits(spec, obstacles, fill.in, centre, radius * (1 - rounding));
                               }};
    const auto seed = static_cast<std::uint64_t>(draws.uniform(order_draw, 1) * 0x1p53);
    auto centres = particles::random_addition(room, radii, seed);
    if (!centres) require_some(spec, fill, obstacles);
    require(centres.has_value(), name_of(spec, fill.mix) +
                                     ": so many particles find no place at random without overlap: make the region "
                                     "larger, the number smaller, or fill \"as\": \"lattice\"");
    return *centres;
}

enum class ByMembers { at_random, lowest };

/// Returns the places of clumps, one after the other, until one finds none without overlap of members. `lowest`: from a
/// random place down to the lowest one that random tries in ever smaller boxes find. Only places are drawn again, so
/// that orientations stay as drawn.
std::vector<Vec3> by_members(const Spec& spec, const Fill& fill, const Draws& draws,
                             const std::vector<Draws::Particle>& particles, const Obstacles& obstacles, ByMembers how) {
    const Bounds bounds = bounds_in(spec, fill.in);
    Neighbourhood near(spec.domain, widest_in(spec, fill.mix));
    std::vector<Vec3> centres;
    for (std::uint64_t n = 0; n < particles.size(); ++n) {
        const auto orientation = draws.orientation(particles[n].species, n);
        const auto balls_at = [&](const Vec3& x) { return balls_of(spec, particles[n], x, orientation); };
        const auto lies_free = [&](const geometry::Ball& ball) {
            return fill.in.depth(ball.centre) >= ball.radius * (1 - rounding) &&
                   !near.occupied(ball.centre, ball.radius) && !obstacles.touch(ball.centre, ball.radius);
        };
        const auto place = [&](const Bounds& in, std::uint64_t attempt) -> std::optional<Vec3> {
            Vec3 x{};
            for (std::size_t k = 0; k < 3; ++k)
                x[k] = in.low[k] +
                       (in.high[k] - in.low[k]) * draws.uniform(place_draw, stats::splitmix64(n) + 3 * attempt + k);
            if (spec.domain.outside(x) || !std::ranges::all_of(balls_at(x), lies_free)) return std::nullopt;
            return x;
        };
        std::optional<Vec3> found;
        for (std::uint64_t attempt = 0; attempt < tries_by_members && !found; ++attempt) found = place(bounds, attempt);
        if (!found) break;
        double reach = geometry::norm(bounds.high - bounds.low);
        for (std::uint64_t attempt = 0; how == ByMembers::lowest && attempt < tries_of_lower; ++attempt) {
            reach *= shrinkage;
            Bounds in = bounds;
            for (std::size_t k = 0; k < 3; ++k) {
                in.low[k] = std::max(in.low[k], (*found)[k] - reach);
                in.high[k] = std::min(in.high[k], (*found)[k] + (k < 2 ? reach : 0));
            }
            if (const auto lower = place(in, tries_by_members + attempt)) found = lower;
        }
        centres.push_back(*found);
        for (const auto& ball : balls_at(*found)) near.add(ball.centre, ball.radius);
    }
    return centres;
}

/// As many of the next particles as cover a share of the layer; fewer where the region is narrower there.
std::vector<Vec3> layer_of(const particles::Room& room, const std::vector<Draws::Particle>& particles, std::size_t next,
                           std::uint64_t seed) {
    std::vector<double> radii;
    double free = rain_cover * (room.high[0] - room.low[0]) * (room.high[1] - room.low[1]);
    for (; next < particles.size() && free > 0; ++next) {
        radii.push_back(particles[next].radius);
        free -= std::numbers::pi * particles[next].radius * particles[next].radius;
    }
    while (!radii.empty()) {
        if (auto centres = particles::random_addition(room, radii, seed)) return *centres;
        radii.resize(radii.size() / 2);
    }
    return {};
}

/// Layers as high as the widest particle, from the bottom up, each filled at random, as far as there is room.
std::vector<Vec3> as_rain(const Spec& spec, const Fill& fill, const Draws& draws,
                          const std::vector<Draws::Particle>& particles, const Obstacles& obstacles) {
    const Bounds bounds = bounds_in(spec, fill.in);
    const double height = rain_layer * widest_in(spec, fill.mix);
    const auto periodic = periodic_in(spec, bounds);
    std::vector<Vec3> centres;
    for (std::uint64_t layer = 0; centres.size() < particles.size(); ++layer) {
        particles::Room room{
            bounds.low, bounds.high, {periodic[0], periodic[1], false}, [&](const Vec3& centre, double radius) {
                return fits(spec, obstacles, fill.in, centre, radius * (1 - rounding));
            }};
        room.low[2] += height * static_cast<double>(layer);
        room.high[2] = std::min(room.high[2], room.low[2] + height);
        if (room.high[2] - room.low[2] < height * (1 - rounding)) break;
        const auto seed = static_cast<std::uint64_t>(draws.uniform(order_draw, 2 + layer) * 0x1p53);
        for (const Vec3& centre : layer_of(room, particles, centres.size(), seed)) centres.push_back(centre);
    }
    return centres;
}

/// The lowest spheres of a random close packing of the widest ones, which repeats itself; at most as many as are
/// wanted.
std::vector<Vec3> packed(const Spec& spec, const Fill& fill, const Draws& draws, const Obstacles& obstacles) {
    const double largest = widest_in(spec, fill.mix);
    const Bounds bounds = bounds_in(spec, fill.in);
    double widest = 0;
    for (std::size_t k = 0; k < 3; ++k) widest = std::max(widest, (bounds.high[k] - bounds.low[k]) / largest);
    const particles::PackingRequest request{.edge = std::clamp(widest, least_edge, most_edge),
                                            .fraction = packed_fraction,
                                            .seed = static_cast<std::uint64_t>(draws.uniform(order_draw, 1) * 0x1p53)};
    const auto packing = particles::random_close_packing(request);
    const double scale = largest * (1 + 2 * packing.largest_overlap), edge = packing.edge * scale;
    std::array<std::int64_t, 3> copies{};
    double sites = static_cast<double>(packing.positions.size());
    for (std::size_t k = 0; k < 3; ++k) {
        copies[k] = static_cast<std::int64_t>(std::ceil((bounds.high[k] - bounds.low[k]) / edge));
        sites *= static_cast<double>(copies[k]);
    }
    require(sites < most_sites, "the region of a filling has more than 2e8 places for particles: make it smaller");
    std::vector<Vec3> centres;
    for (std::int64_t z = 0; z < copies[2]; ++z)
        for (std::int64_t y = 0; y < copies[1]; ++y)
            for (std::int64_t x = 0; x < copies[0]; ++x)
                for (const auto& place : packing.positions) {
                    const Vec3 centre{bounds.low[0] + scale * place[0] + edge * static_cast<double>(x),
                                      bounds.low[1] + scale * place[1] + edge * static_cast<double>(y),
                                      bounds.low[2] + scale * place[2] + edge * static_cast<double>(z)};
                    if (lies_within(bounds, centre, largest / 2) &&
                        fits(spec, obstacles, fill.in, centre, largest / 2 * (1 - rounding)))
                        centres.push_back(centre);
                }
    std::ranges::sort(centres, {}, [](const Vec3& c) { return std::array{c[2], c[1], c[0]}; });
    centres.resize(std::min(centres.size(), static_cast<std::size_t>(fill.count)));
    return centres;
}

}  // namespace

std::vector<Vec3> places_of(const Spec& spec, const Fill& fill, const Draws& draws,
                            const std::vector<Draws::Particle>& given, const Obstacles& obstacles) {
    auto particles = given;  // the spheres around them
    for (auto& particle : particles) particle.radius *= spec.species[particle.species].girth();
    const bool shaped = has_shapes(spec, fill);
    std::vector<Vec3> centres;
    switch (fill.as) {
        case Fill::As::cells:
            return in_cells(spec, fill, draws, obstacles);
        case Fill::As::random:
            if (!shaped) return at_random(spec, fill, draws, particles, obstacles);
            break;
        case Fill::As::rain:
            centres = as_rain(spec, fill, draws, particles, obstacles);
            break;
        case Fill::As::packed:
            centres = packed(spec, fill, draws, obstacles);
            break;
        case Fill::As::lattice:
            centres = on_lattice(spec, fill, draws, obstacles);
            break;
    }
    // Spheres around long grains of any direction take more room than the grains.
    const auto try_members = [&](ByMembers how) {
        if (shaped && centres.size() < given.size()) centres = by_members(spec, fill, draws, given, obstacles, how);
    };
    if (fill.as != Fill::As::packed) try_members(ByMembers::at_random);
    try_members(ByMembers::lowest);
    require_all(spec, fill, centres.size(), obstacles);
    return centres;
}

void require_places(const Spec& spec) {
    for (const Fill& fill : of_kind<Fill>(spec.fills)) {
        if (fill.as != Fill::As::lattice || fill.count > most_tried || fill.at > 0) continue;
        if (has_shapes(spec, fill)) continue;  // they may find a place at random
        const Obstacles obstacles(spec, fill.mix, walls_in(spec, 0, {{0.0}, {}}), widest_in(spec, fill.mix), 0,
                                  dem::MovingWall::Searches::few);
        require_all(spec, fill, sites_in(spec, fill, Pitch(spec, fill.mix), obstacles).size(), obstacles);
    }
}

double widest_in(const Spec& spec, const Mix& mix) {
    double largest = 0;
    for (const auto& [species, share] : mix)
        if (share > 0) largest = std::max(largest, spec.species[species].widest());
    return largest;
}

}  // namespace grainsweep::machine
