#include "solver/dem/fast/faults.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <numbers>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/pieced_walls.hpp"
#include "solver/dem/fast/wall_lists.hpp"
#include "solver/dem/limits.hpp"

namespace grainsweep::dem::fast {

namespace {

std::string where_and_when(const FaultView& s, std::int32_t i) {
    Vec3 x{};
    for (std::size_t a = 0; a < 3; ++a) x[a] = s.scale.centre[a] + s.field.records[i].position[a] * s.scale.unit[a];
    return place_and_time(s.id[i], x, s.steps, s.time);
}

/// Words for a limit that the time step sets.
const char* reason_of(float limit) {
    return limit < static_cast<float>(overlap_limit) ? ": beyond, the time step is too long for the contact" : "";
}

/// In largest diameters; `ahead`: steps by which positions are further than where the overlap is asked for.
double overlap_of(const FaultView& s, const Record& a, const Record& b, double ahead) {
    double square = 0;
    for (int q = 0; q < 3; ++q) {
        const auto offset = static_cast<std::int32_t>(static_cast<std::uint32_t>(a.position[q]) -
                                                      static_cast<std::uint32_t>(b.position[q]));
        const double step = static_cast<double>(a.velocity[q]) - static_cast<double>(b.velocity[q]);
        const double moved = ahead > 0 ? ahead * step : 0;  // a step that is no number
        square += std::pow(offset * s.field.constants.unit[q] - moved, 2);
    }
    return static_cast<double>(a.radius) + static_cast<double>(b.radius) - std::sqrt(square);
}

struct Depth {
    std::int32_t particle = 0, wall = 0;
};

/// The listed particle that is deepest in a wall, over its own diameter.
Depth deepest_at_walls(const FaultView& s) {
    Depth depth;
    double gap = std::numeric_limits<double>::infinity();
    std::vector<WallTouch> touched;
    for (std::size_t w = 0; w < s.walls.count(); ++w)
        for_each_near(s.field, s.walls, w, [&](std::int32_t i, std::int32_t) {
            const Record& r = s.field.records[i];
            const double radius = static_cast<double>(r.radius) * s.scale.length;
            touched.clear();
            s.walls[w].find(0, position_of(r, s.scale), radius, touched);
            for (const WallTouch& touch : touched)
                if (const double g = (touch.place.distance - radius) / radius; g < gap)
                    gap = g, depth = {i, static_cast<std::int32_t>(w)};
        });
    return depth;
}

}  // namespace

bool contacts_differ(const Setup& setup) {
    return setup.kinds.densities.size() > 1;
}

SoundOverlaps deepest_overlaps(const Setup& setup) {
    return {static_cast<float>(overlap_limit), static_cast<float>(setup.deepest_in_walls)};
}

SoundOverlaps resolved_overlaps(const Setup& setup) {
    double radius = std::numeric_limits<double>::infinity(), density = radius, slope = 0;
    for_each_extreme_sphere(setup, [&](const Sphere& sphere) {
        radius = std::min(radius, sphere.radius);
        density = std::min(density, density_of(setup, sphere));
    });
    if (!std::isfinite(radius)) return deepest_overlaps(setup);
    for (const Material& m : materials_of(setup)) slope = std::max(slope, normal_slope(m));
    const bool linear = materials_of(setup).front().normal_law == NormalLaw::linear;
    const double mass = 4.0 / 3 * std::numbers::pi * radius * radius * radius * density;
    const auto limit = [&](double share, double deepest) {  // R* = share R, m* = share m
        const double root =
            largest_sound_swing * largest_sound_swing * share * mass / (slope * setup.time_step * setup.time_step);
        if (linear) return static_cast<float>(root >= 1 ? deepest : 0);  // at any overlap
        return static_cast<float>(std::min(deepest, root * root / (share * radius) / (2 * radius)));
    };
    return {limit(0.5, overlap_limit), limit(1, setup.deepest_in_walls)};
}

/// Returns the sentence of the fastest wall.
static std::string describe_fast_wall(const FaultView& s) {
    std::size_t worst = 0;
    double most = -1;
    for (std::size_t w = 0; w < s.walls.count(); ++w)
        if (const double speed = s.walls[w].fastest_surface(); s.walls[w].present() && speed > most)
            most = speed, worst = w;
    char text[200];
    std::snprintf(text, sizeof text,
                  "wall %zu moves at %.4g m/s, %.3g smallest diameters in one step (limit %.3g), after %lld steps, "
                  "%.6g s",
                  worst, most, most / s.scale.speed() / static_cast<double>(s.smallest_diameter), travel_limit,
                  static_cast<long long>(s.steps), s.time);
    return text;
}

std::string describe_fast_body(const FaultView& s) {
    std::int32_t worst = 0;
    double most = -1;
    for (std::int32_t i = 0; i < s.field.count; ++i)
        for (const float v : s.field.records[i].velocity) {
            const double travel =
                std::isfinite(v) ? std::abs(static_cast<double>(v)) : std::numeric_limits<double>::infinity();
            if (travel > most) most = travel, worst = i;
        }
    if (most < travel_limit * static_cast<double>(s.smallest_diameter)) return describe_fast_wall(s);
    char text[160];
    std::snprintf(text, sizeof text, "a particle moves %.3g smallest diameters in one step (limit %.3g)",
                  most / static_cast<double>(s.smallest_diameter), travel_limit);
    return text + where_and_when(s, worst);
}

std::string describe_faster_than(const FaultView& s, double limit) {
    std::int32_t worst = 0;
    double most = -1;
    for (std::int32_t i = 0; i < s.field.count; ++i) {
        const float* v = s.field.records[i].velocity;
        const double speed =
            std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])) *
            s.scale.speed();
        if (speed > most) most = speed, worst = i;
    }
    if (!(most > limit)) return {};
    return flaw_of_speed(most, limit) + where_and_when(s, worst);
}

std::string describe(const FaultView& s, const std::string& what, std::int32_t i) {
    return what + where_and_when(s, i);
}

std::string unsound_contact(const FaultView& s, bool advanced) {
    const Scale& scale = s.scale;
    const double ahead = advanced ? 1 : 0;
    const auto judge = [&](const Material& m, double overlap, double smaller, double radius, double inverse_mass,
                           double deepest) {
        const double over = m.normal_law == NormalLaw::linear ? 1 : std::sqrt(radius * std::max(overlap, 0.0));
        return flaw_of_contact(overlap / (2 * smaller),
                               scale.time * std::sqrt(normal_slope(m) * over * inverse_mass / scale.mass), deepest);
    };
    for (std::int32_t k = 0; k < s.field.inner_count; ++k) {
        const std::int32_t i = index_at(s.field.inner_first[k]), j = index_at(s.field.inner_second[k]);
        if (i >= s.field.count || j >= s.field.count) continue;
        const Record &a = s.field.records[i], &b = s.field.records[j];
        const double one = radius_of(a, scale), other = radius_of(b, scale);
        const Material& m = s.table.pairs()[place_of_pair(s.field.kind[i], s.field.kind[j])];
        const std::string flaw =
            judge(m, overlap_of(s, a, b, ahead) * scale.length, std::min(one, other), one * other / (one + other),
                  double{a.inverse_mass} + double{b.inverse_mass}, overlap_limit);
        if (!flaw.empty()) return flaw + "particle " + std::to_string(s.id[j]) + where_and_when(s, i);
    }
    std::string found;
    std::vector<WallTouch> touched;
    for (std::size_t w = 0; w < s.walls.count(); ++w)
        for_each_near(s.field, s.walls, w, [&](std::int32_t i, std::int32_t) {
            if (!found.empty()) return;
            const Record& r = s.field.records[i];
            const double radius = radius_of(r, scale);
            const Material m = s.table.at_wall(s.walls[w].wall(), s.field.kind[i]);
            touched.clear();
            Vec3 x = position_of(r, scale);
            for (std::size_t q = 0; q < 3; ++q) x[q] -= ahead * static_cast<double>(r.velocity[q]) * scale.length;
            s.walls[w].find(0, x, radius, touched);
            for (const WallTouch& touch : touched) {
                const std::string flaw = judge(m, radius - touch.place.distance, radius, radius, double{r.inverse_mass},
                                               double{s.sound.wall});
                if (found.empty() && !flaw.empty()) found = flaw + "wall " + std::to_string(w) + where_and_when(s, i);
            }
        });
    return found;
}

std::string describe_frozen(const FaultView& s) {
    std::vector<std::uint32_t> all, frozen;
    std::vector<Vec3> position(static_cast<std::size_t>(s.field.count));
    std::vector<double> radius(position.size());
    for (std::uint32_t i = 0; i < position.size(); ++i) {
        const Record& r = s.field.records[i];
        if (r.inverse_mass > 0) continue;
        all.push_back(i);
        position[i] = position_of(r, s.scale);
        radius[i] = radius_of(r, s.scale);
    }
    for (std::size_t w = 0; w < s.walls.count(); ++w) {
        const MovingWall& wall = s.walls[w];
        if (!wall.free() || !wall.present()) continue;
        frozen.clear();
        std::ranges::copy_if(all, std::back_inserter(frozen),
                             [&](std::uint32_t i) { return wall.wall().touches(s.field.kind[i]); });
        if (const auto entry = wall.reaches(frozen, position, {0, radius}, deepest_frozen))
            return flaw_of_frozen(w) + where_and_when(s, static_cast<std::int32_t>(frozen[*entry]));
    }
    return {};
}

/// Looks for the pair again, by the positions the forces were computed at or one step later.
std::string describe_overlap(const FaultView& s, const Tally& tally) {
    double most = 0;
    std::int32_t first = 0, second = -1;
    for (std::int32_t k = 0; k < s.field.inner_count; ++k) {
        const std::int32_t i = index_at(s.field.inner_first[k]), j = index_at(s.field.inner_second[k]);
        const Record &a = s.field.records[i], &b = s.field.records[j];
        const double share = overlap_of(s, a, b, 0) / (2 * static_cast<double>(std::min(a.radius, b.radius)));
        if (share > most) most = share, first = i, second = j;
    }
    char text[240];
    if (tally.overlap > s.sound.pair && second >= 0) {
        std::snprintf(text, sizeof text, "overlap of %.3g diameters (limit %.3g%s) with particle %d",
                      static_cast<double>(tally.overlap), static_cast<double>(s.sound.pair), reason_of(s.sound.pair),
                      s.id[second]);
        return text + where_and_when(s, first);
    }
    const Depth depth = deepest_at_walls(s);
    std::snprintf(text, sizeof text, "overlap of %.3g diameters (limit %.3g%s) with wall %d",
                  static_cast<double>(tally.wall_overlap), static_cast<double>(s.sound.wall), reason_of(s.sound.wall),
                  depth.wall);
    return text + where_and_when(s, depth.particle);
}

}  // namespace grainsweep::dem::fast
