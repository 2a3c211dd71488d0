#include "solver/machine/drawing.hpp"

#include "solver/geometry/level_surface.hpp"
#include "solver/machine/setup.hpp"
#include "solver/scenes/dem_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace grainsweep::machine {
namespace {

using geometry::cross;
using geometry::norm;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;

constexpr std::int32_t sides = 32;

void add_line(WallSurface& frame, const Vec3& from, const Vec3& to) {
    const auto first = static_cast<std::int32_t>(frame.corners.size());
    frame.corners.push_back(from);
    frame.corners.push_back(to);
    frame.edges.push_back({first, first + 1});
}

Vec3 across(const Vec3& axis) {
    const Vec3 other = std::abs(axis[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return (1 / norm(cross(axis, other))) * cross(axis, other);
}

void add_circle(WallSurface& frame, const Vec3& centre, const Vec3& axis, double radius) {
    const Vec3 u = across(axis), v = cross(axis, u);
    const auto corner = [&](std::int32_t k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        return centre + radius * std::cos(angle) * u + radius * std::sin(angle) * v;
    };
    for (std::int32_t k = 0; k < sides; ++k) add_line(frame, corner(k), corner(k + 1));
}

/// A cylinder along an axis as far as it is in the domain.
Region::Round within(Region::Round round, const geometry::Domain& domain) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (round.axis[k] != 1) continue;
        const double low = std::max(round.base[k], domain.low[k]);
        const double high = std::min(round.base[k] + round.length, domain.high[k]);
        if (!(low < high)) return round;
        round.base[k] = low;
        round.length = high - low;
    }
    return round;
}

/// Of a half space the outline of its plane in the domain; of combinations all their parts.
void add_region(WallSurface& frame, const Region& region, const geometry::Domain& domain) {
    if (const auto* box = std::get_if<Region::Box>(&region.is)) {
        const Bounds seen = shared({box->low, box->high}, {domain.low, domain.high});
        add_box(seen.low, seen.high, frame);
    } else if (const auto* given = std::get_if<Region::Round>(&region.is)) {
        const Region::Round cut = within(*given, domain);
        const Region::Round* round = &cut;
        for (const double radius : {round->radius, round->inner}) {
            if (!(radius > 0)) continue;
            const Vec3 u = across(round->axis), v = cross(round->axis, u), along = round->length * round->axis;
            add_circle(frame, round->base, round->axis, radius);
            add_circle(frame, round->base + along, round->axis, radius);
            for (const Vec3& side : {u, v, -1 * u, -1 * v})
                add_line(frame, round->base + radius * side, round->base + radius * side + along);
        }
    } else if (const auto* ball = std::get_if<Region::Ball>(&region.is)) {
        for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
            add_circle(frame, ball->centre, axis, ball->radius);
    } else if (const auto* half = std::get_if<Region::Half>(&region.is)) {
        const auto polygon =
            surface_of(dem::Wall(geometry::Plane{half->point, half->normal}), "", domain.low, domain.high, 0);
        for (std::size_t k = 0; k < polygon.corners.size(); ++k)
            add_line(frame, polygon.corners[k], polygon.corners[(k + 1) % polygon.corners.size()]);
    } else {  // a level set has no parts: the box beside it shows where it is
        each_part(region, [&](const Region& part) { add_region(frame, part, domain); });
    }
}

void add_frame(Snapshot& picture, const std::string& name, const Region& region, const geometry::Domain& domain) {
    WallSurface frame;
    frame.name = name;
    add_region(frame, region, domain);
    if (!frame.edges.empty()) picture.walls.push_back(std::move(frame));
}

/// The plane of a probe that has one.
std::optional<Region> plane_of(const Options& options) {
    if (!options.has("point") || !options.has("normal")) return std::nullopt;
    return Region{Region::Half{options.vector("point"), options.vector("normal")}};
}

void add_particles(Snapshot& picture, const Filled& filled) {
    auto& id = picture.scalars["id"];
    auto& mobile = picture.scalars["mobile"];
    auto& diameter = picture.scalars["diameter"];
    auto& species = picture.scalars["species"];
    for (std::size_t k = 0; k < filled.spheres.size(); ++k) {
        picture.positions.push_back(filled.spheres[k].position);
        id.push_back(static_cast<double>(k));
        mobile.push_back(1);
        diameter.push_back(2 * filled.spheres[k].radius);
        species.push_back(filled.species[k]);
    }
    picture.units = {{"diameter", "m"}};
}

}  // namespace

void add_cells(Snapshot& picture, const Spec& spec) {
    constexpr int grid = 36;
    for (const Cut& cut : of_kind<Cut>(spec.fills)) {
        const auto* set = cut.glued ? std::get_if<Region::LevelSet>(&cut.in.is) : nullptr;
        if (set == nullptr) continue;
        const Region above{Region::LevelSet{set->cell, set->edge, 0, 1, set->at}};
        const Vec3 high{cut.edge, cut.edge, cut.edge};
        auto surface = geometry::level_surface([&](const Vec3& x) { return above.depth(x); }, {}, high, grid);
        picture.walls.push_back({"cell", std::move(surface.corners), std::move(surface.triangles), {}});
        add_box({}, high, picture.walls.back());
    }
}

double longest_time(const Spec& spec) {
    double end = 0;
    for (const Phase& phase : spec.phases) end += phase.duration;
    return end;
}

Snapshot drawing(const Spec& spec, const Filled& filled, double time) {
    Snapshot picture;
    add_particles(picture, filled);
    PhaseTimes times;
    std::size_t now = 0;
    double begin = 0;
    for (std::size_t p = 0; p < spec.phases.size() && begin <= time; ++p) {
        now = p;
        times.begin.push_back(begin);
        begin += spec.phases[p].duration;
        if (begin <= time) times.end.push_back(begin);
    }
    const auto walls = walls_in(spec, now, times);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (!walls[w].present) continue;
        auto surface = surface_of(walls[w], spec.walls[w].name, spec.domain.low, spec.domain.high, time);
        if (!surface.corners.empty()) picture.walls.push_back(std::move(surface));
    }
    add_frame(picture, "domain", {Region::Box{spec.domain.low, spec.domain.high}}, spec.domain);
    int fills = 0;
    for (const Fill& fill : of_kind<Fill>(spec.fills))
        add_frame(picture, "fill_" + std::to_string(++fills), fill.in, spec.domain);
    add_cells(picture, spec);
    for (const Feed& feed : spec.feeds) add_frame(picture, feed.name, feed.through, spec.domain);
    for (const Measure& measure : spec.measures) {
        if (const auto region = measure.options.region("in")) add_frame(picture, measure.name, *region, spec.domain);
        if (const auto plane = plane_of(measure.options)) add_frame(picture, measure.name, *plane, spec.domain);
    }
    for (std::size_t k = 0; k < 3; ++k)
        if (spec.domain.periodic[k]) picture.periods[k] = spec.domain.length(k);
    return picture;
}

}  // namespace grainsweep::machine
