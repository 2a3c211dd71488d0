#include "solver/machine/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

namespace grainsweep::machine {

using geometry::dot;
using geometry::norm;
using geometry::operator-;
using geometry::operator+;
using geometry::operator*;

namespace {

constexpr std::array box_fields_of_region = {
    needed(fields::vector<&BoxRegion::low>("low", "m", "lower corner")),
    needed(fields::vector<&BoxRegion::high>("high", "m", "upper corner")),
};
constexpr std::array round_fields = {
    needed(fields::vector<&RoundRegion::base>("base", "m", "centre of the first end")),
    fields::direction<&RoundRegion::axis>("axis", "direction to the second end"),
    needed(fields::quantity<&RoundRegion::radius>("radius", "m", "")),
    fields::quantity<&RoundRegion::inner>("inner", "m", "radius of a hollow"),
    needed(fields::quantity<&RoundRegion::length>("length", "m", "")),
};
constexpr std::array ball_fields = {
    needed(fields::vector<&BallRegion::centre>("centre", "m", "")),
    needed(fields::quantity<&BallRegion::radius>("radius", "m", "")),
};
constexpr std::array half_fields = {
    fields::vector<&HalfRegion::point>("point", "m", "on the plane"),
    needed(fields::direction<&HalfRegion::normal>("normal", "direction, into the region")),
};
constexpr auto cell_words = [] {
    std::array<std::string_view, geometry::tpms_cells.size()> words;
    for (std::size_t k = 0; k < words.size(); ++k) words[k] = geometry::tpms_cells[k].name;
    return words;
}();
constexpr std::array level_set_rows = {
    fields::choice<&LevelSetRegion::cell>("cell", "the surface", cell_words, "\"schwarz_p\""),
    needed(fields::quantity<&LevelSetRegion::edge>("edge", "m", "of a cubic cell")),
    fields::quantity<&LevelSetRegion::shell>("shell", "m", "largest thickness of the shell around the surface"),
    fields::quantity<&LevelSetRegion::side>("side", "1",
                                            "0: the shell; 1 or -1: where the level set has this sign, outside of it"),
    fields::vector<&LevelSetRegion::at>("at", "m", "lowest corner of a cell"),
};
constexpr std::array moving_fields = {
    needed(Field{"in", Field::Kind::region, "the region where it is at the start"}),
    needed(Field{"with", Field::Kind::walls, "the wall; its turns do not count"}),
    fields::direction<&MovingRegion::along>("along", "direction in which it follows the wall; default: all"),
};
using AnyKind = decltype(Region::is);
constexpr std::array region_rows = {
    fields::alternative<AnyKind, BoxRegion>("box", "a box", box_fields_of_region),
    fields::alternative<AnyKind, RoundRegion>("cylinder", "a cylinder, hollow or not", round_fields),
    fields::alternative<AnyKind, BallRegion>("ball", "a ball", ball_fields),
    fields::alternative<AnyKind, HalfRegion>("half_space", "one side of a plane", half_fields),
    fields::alternative<AnyKind, LevelSetRegion>(
        "level_set", "the shell of a triply periodic minimal surface, or one side of it, without end", level_set_rows),
    fields::alternative<AnyKind, MovingRegion>("moving", "a region that moves with a wall", moving_fields),
    fields::alternative<AnyKind, AllRegions>("all", "a list of regions: where all of them are"),
    fields::alternative<AnyKind, AnyRegion>("any", "a list of regions: where one of them is"),
    fields::alternative<AnyKind, NotRegion>("not", "a region: outside of it"),
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Bounds everywhere{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};

double depth_in(const Region::Box& box, const Vec3& x) {
    double depth = infinity;
    for (std::size_t k = 0; k < 3; ++k) depth = std::min({depth, x[k] - box.low[k], box.high[k] - x[k]});
    return depth;
}

double depth_in(const Region::Round& round, const Vec3& x) {
    const double along = dot(x - round.base, round.axis);
    const double from_axis = norm(x - round.base - along * round.axis);
    const double depth = std::min({along, round.length - along, round.radius - from_axis});
    return round.inner > 0 ? std::min(depth, from_axis - round.inner) : depth;
}

double depth_in(const Region::Ball& ball, const Vec3& x) {
    return ball.radius - norm(x - ball.centre);
}

double depth_in(const Region::Half& half, const Vec3& x) {
    return dot(x - half.point, half.normal);
}

double level_of(const Region::LevelSet& set) {
    return geometry::traits(set.cell).shell_gradient * std::sin(std::numbers::pi * set.shell / set.edge);
}

/// By the steepest gradient of f. Points of the shell's surface belong to the shell.
double depth_in(const Region::LevelSet& set, const Vec3& x) {
    Vec3 bar{};
    for (std::size_t k = 0; k < 3; ++k) bar[k] = std::numbers::pi * (2 * (x[k] - set.at[k]) / set.edge - 1);
    const double f = geometry::tpms_value(set.cell, bar), level = level_of(set);
    const double inside = set.side == 0 ? level - std::abs(f) : set.side * f - std::nextafter(level, infinity);
    return inside * set.edge / (2 * std::numbers::pi * geometry::traits(set.cell).steepest);
}

Vec3 moved_by(const Region::Moving& moving) {
    return moving.moved ? *moving.moved : Vec3{};
}

double depth_in(const Region::Moving& moving, const Vec3& x) {
    return moving.of.front().depth(x - moved_by(moving));
}

double depth_in(const Region::All& all, const Vec3& x) {
    double depth = infinity;
    for (const Region& region : all.of) depth = std::min(depth, region.depth(x));
    return depth;
}

double depth_in(const Region::Any& any, const Vec3& x) {
    double depth = -infinity;
    for (const Region& region : any.of) depth = std::max(depth, region.depth(x));
    return depth;
}

double depth_in(const Region::Not& none, const Vec3& x) {
    return 0 - none.of.front().depth(x);
}

/// Of the images whose boxes may contain the point. The one nearest to the middle of its box comes first, and of a
/// region of many periods no more than two on each side of it count: nearly every point is in that one, or in none.
double depth_in(const Region::Images& images, const Vec3& x) {
    const Region& region = images.of.front();
    const Bounds box = region.bounds();
    Vec3 first{}, last{}, nearest{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (!images.domain.periodic[k] || !std::isfinite(box.high[k] - box.low[k])) continue;
        const double period = images.domain.length(k);
        first[k] = std::ceil((box.low[k] - x[k]) / period) * period;
        last[k] = std::max(first[k], std::floor((box.high[k] - x[k]) / period) * period);
        nearest[k] = std::round(((box.low[k] + box.high[k]) / 2 - x[k]) / period) * period;
        first[k] = std::max(first[k], nearest[k] - 2 * period);
        last[k] = std::min(last[k], nearest[k] + 2 * period);
    }
    double depth = region.depth(x + nearest);
    if (depth >= 0) return depth;
    for (double a = first[0]; a <= last[0]; a += images.domain.length(0))
        for (double b = first[1]; b <= last[1]; b += images.domain.length(1))
            for (double c = first[2]; c <= last[2]; c += images.domain.length(2))
                depth = std::max(depth, region.depth(x + Vec3{a, b, c}));
    return depth;
}

Bounds bounds_of(const Region::Box& box) {
    return {box.low, box.high};
}

Bounds bounds_of(const Region::Round& round) {
    Bounds bounds;
    for (std::size_t k = 0; k < 3; ++k) {
        const double across = round.radius * std::sqrt(std::max(0.0, 1 - round.axis[k] * round.axis[k]));
        const double end = round.base[k] + round.length * round.axis[k];
        bounds.low[k] = std::min(round.base[k], end) - across;
        bounds.high[k] = std::max(round.base[k], end) + across;
    }
    return bounds;
}

Bounds bounds_of(const Region::Ball& ball) {
    const Vec3 reach{ball.radius, ball.radius, ball.radius};
    return {ball.centre - reach, ball.centre + reach};
}

/// A half space across an axis bounds it on one side.
Bounds bounds_of(const Region::Half& half) {
    Bounds bounds = everywhere;
    for (std::size_t k = 0; k < 3; ++k) {
        if (half.normal[k] == 1) bounds.low[k] = half.point[k];
        if (half.normal[k] == -1) bounds.high[k] = half.point[k];
    }
    return bounds;
}

Bounds bounds_of(const Region::LevelSet&) {
    return everywhere;
}

Bounds bounds_of(const Region::Moving& moving) {
    const Bounds bounds = moving.of.front().bounds();
    return {bounds.low + moved_by(moving), bounds.high + moved_by(moving)};
}

Bounds bounds_of(const Region::All& all) {
    Bounds bounds = everywhere;
    for (const Region& region : all.of) bounds = shared(bounds, region.bounds());
    return bounds;
}

Bounds bounds_of(const Region::Any& any) {
    Bounds bounds = geometry::nowhere;
    for (const Region& region : any.of) bounds.widen(region.bounds());
    return bounds;
}

Bounds bounds_of(const Region::Not&) {
    return everywhere;
}

Bounds bounds_of(const Region::Images& images) {
    return images.of.front().bounds();
}

/// Ends a region that is longer than the period along an axis at the faces, or nowhere.
void end_at_faces(Region& region, const Bounds& faces, std::size_t k) {
    if (auto* box = std::get_if<Region::Box>(&region.is)) {
        box->low[k] = faces.low[k], box->high[k] = faces.high[k];
    } else if (auto* round = std::get_if<Region::Round>(&region.is);
               round != nullptr && std::abs(round->axis[k]) == 1) {
        const bool finite = std::isfinite(faces.low[k]);
        const double far = round->length;  // at least a period
        round->base[k] = !finite              ? round->base[k] - far * round->axis[k]
                         : round->axis[k] > 0 ? faces.low[k]
                                              : faces.high[k];
        round->length = finite ? faces.high[k] - faces.low[k] : 3 * far;
    }
}

/// How often the images of a region lie over each other along an axis, at most.
double images_along(const Region& region, const geometry::Domain& domain, std::size_t k) {
    const Bounds box = region.bounds();
    return (box.high[k] - box.low[k]) / domain.length(k);
}

bool is_unit(const Vec3& a) {
    return std::abs(norm(a) - 1) < 1e-9;
}

const char* flaw_of(const Region::Box& box) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!(box.low[k] < box.high[k])) return "\"low\" of a box must lie below \"high\" along every axis";
    return "";
}

const char* flaw_of(const Region::Round& round) {
    if (!is_unit(round.axis)) return "the axis of a cylinder must not be 0";
    if (!(round.radius > 0 && round.length > 0)) return "a cylinder needs a radius and a length above 0";
    return round.inner >= 0 && round.inner < round.radius ? "" : "\"inner\" of a cylinder is from 0 to its radius";
}

const char* flaw_of(const Region::Ball& ball) {
    return ball.radius > 0 ? "" : "a ball needs a radius above 0";
}

const char* flaw_of(const Region::Half& half) {
    return is_unit(half.normal) ? "" : "the normal of a half space must not be 0";
}

const char* flaw_of(const Region::LevelSet& set) {
    if (set.side != 0 && std::abs(set.side) != 1) return "\"side\" of a level set is 1, -1, or 0 for its shell";
    if (!(set.edge > 0)) return "a level set needs an edge above 0";
    return set.shell >= 0 && set.shell < set.edge / 2 ? ""
                                                      : "the shell of a level set must be thinner than half the edge";
}

template <class Combined>
const char* flaw_of(const Combined& combined) {
    if (combined.of.empty()) return "a combination of regions needs one";
    for (const Region& region : combined.of)
        if (const char* flaw = region.flaw(); *flaw != '\0') return flaw;
    return "";
}

}  // namespace

std::span<const Type> region_types() {
    return region_rows;
}

/// Diameter of the largest disc in the face z = 0 of the unit cube, on a grid of its points.
static double widest_disc(const Region& region) {
    constexpr std::size_t points = 256, far = 4 * points;
    // Steps along its row to the nearest point outside; more than any distance where there is none.
    std::vector<std::size_t> steps(points * points, far);
    for (std::size_t row = 0; row < points; ++row) {
        std::size_t* const here = &steps[row * points];
        const auto at = [](std::size_t k) { return (static_cast<double>(k) + 0.5) / points; };
        for (std::size_t k = 0; k < points; ++k)
            here[k] = !region.contains({at(k), at(row), 0}) ? 0 : k > 0 ? here[k - 1] + 1 : far;
        for (std::size_t k = points - 1; k-- > 0;) here[k] = std::min(here[k], here[k + 1] + 1);
    }
    // Then over all rows: squared distance = steps along that row squared + rows between squared.
    std::size_t largest = 0;
    for (std::size_t place = 0; place < points * points; ++place) {
        std::size_t nearest = steps[place] * steps[place];
        for (std::size_t row = 0; row < points && nearest > largest; ++row) {
            const std::size_t along = steps[row * points + place % points], own = place / points;
            const std::size_t across = row > own ? row - own : own - row;
            nearest = std::min(nearest, along * along + across * across);
        }
        largest = std::max(largest, nearest);
    }
    return std::min(1.0, 2 * std::sqrt(static_cast<double>(largest)) / points);
}

std::span<const Field> level_set_fields() {
    return level_set_rows;
}

double LevelSetRegion::opening() const {
    static std::map<std::tuple<geometry::TpmsCell, double, double>, double> known;
    static std::mutex guard;
    const std::lock_guard lock(guard);
    const auto [found, fresh] = known.try_emplace({cell, side, shell / edge}, 0);
    if (fresh) found->second = widest_disc({{LevelSetRegion{cell, 1, shell / edge, side}}});
    return edge * found->second;
}

RegionNow::RegionNow(const Region& region) : still_(&region) {
    for (Vec3& moved : moved_) {
        const auto* moving = std::get_if<MovingRegion>(&still_->is);
        if (moving == nullptr) break;
        moved = moved_by(*moving);
        still_ = &moving->of.front();
    }
    box_ = std::get_if<BoxRegion>(&still_->is);
    half_ = std::get_if<HalfRegion>(&still_->is);
}

bool Region::contains(const Vec3& x) const {
    if (const auto* all = std::get_if<All>(&is))
        return std::ranges::all_of(all->of, [&](const Region& one) { return one.contains(x); });
    return RegionNow(*this).contains(x);
}

double Region::depth(const Vec3& x) const {
    return std::visit([&](const auto& region) { return depth_in(region, x); }, is);
}

Bounds Region::bounds() const {
    return std::visit([](const auto& region) { return bounds_of(region); }, is);
}

void Region::each_moving(const std::function<void(Moving&)>& visit) {
    if (auto* moving = std::get_if<Moving>(&is)) visit(*moving);
    each_part(*this, [&](Region& part) { part.each_moving(visit); });
}

/// `all`: also those that no centre within the faces needs: of a region that is somewhere else at another time, or that
/// is compared with bodies.
static Region with_images(Region region, const geometry::Domain& domain, bool all) {
    if (auto* moving = std::get_if<Region::Moving>(&region.is)) {
        moving->of.front() = with_images(std::move(moving->of.front()), domain, true);
        return region;
    }
    bool beyond = false, endless = false;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!domain.periodic[k]) continue;
        if (const double times = images_along(region, domain, k); times >= 1 && std::isfinite(times))
            end_at_faces(region, all ? everywhere : Bounds{domain.low, domain.high}, k);
        const Bounds box = region.bounds();
        const bool ends = std::isfinite(box.high[k] - box.low[k]);
        endless = endless || !ends;
        beyond = beyond || (ends && (all || box.low[k] < domain.low[k] || box.high[k] > domain.high[k]));
    }
    if (beyond) return {Region::Images{{std::move(region)}, domain}};
    if (endless) each_part(region, [&](Region& part) { part = with_images(std::move(part), domain, all); });
    return region;
}

Region with_images(Region region, const geometry::Domain& domain) {
    return with_images(std::move(region), domain, false);
}

Region with_images_for_bodies(Region region, const geometry::Domain& domain) {
    return with_images(std::move(region), domain, true);
}

std::optional<double> Region::volume() const {
    if (const auto* images = std::get_if<Images>(&is)) {
        for (std::size_t k = 0; k < 3; ++k)
            if (images->domain.periodic[k] && images_along(images->of.front(), images->domain, k) > 1 + 1e-9)
                return std::nullopt;
        return images->of.front().volume();
    }
    if (const auto* box = std::get_if<Box>(&is)) {
        const Vec3 size = box->high - box->low;
        return size[0] * size[1] * size[2];
    }
    if (const auto* round = std::get_if<Round>(&is))
        return std::numbers::pi * (round->radius * round->radius - round->inner * round->inner) * round->length;
    if (const auto* ball = std::get_if<Ball>(&is))
        return 4 * std::numbers::pi / 3 * ball->radius * ball->radius * ball->radius;
    return std::nullopt;
}

const char* Region::flaw() const {
    return std::visit([](const auto& region) { return flaw_of(region); }, is);
}

}  // namespace grainsweep::machine
