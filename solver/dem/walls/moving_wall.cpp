#include "solver/dem/walls/moving_wall.hpp"

#include "solver/geometry/contact_memory.hpp"
#include "solver/geometry/lines.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

namespace grainsweep::dem {

using namespace geometry;

namespace {

constexpr std::array<Vec3, 3> unit_vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// By how much of it a wall may be longer than the period: files of single precision round to 6e-8 of a coordinate.
constexpr double rounding_of_length = 1e-6;

bool switches(const Motion& motion) {
    return std::visit([](const auto& m) { return m.start > 0 || std::isfinite(m.end); }, motion);
}

/// Calls visit(shape, to_shape, from_shape): positions into the frame of the shape, normals out of it.
template <class S, class Visit>
void in_frame(const S& shape, const Pose& pose, const NearestImage& image, Visit&& visit) {
    if constexpr (Movable<S>)
        if (!pose.turned) {
            visit(
                shape.moved(pose.shift), [&](const Vec3& x) { return image.of(x); }, [](const Vec3& n) { return n; });
            return;
        }
    visit(
        shape, [&](const Vec3& x) { return pose.to_body(image.of(x)); },
        [&](const Vec3& n) { return pose.turned ? pose.turn(n) : n; });
}

/// Appends the places of one particle; a distance that is not a number counts, so that it is reported.
template <class S>
void append(const S& shape, const Vec3& x, double reach, std::uint32_t entry, auto&& from_shape,
            std::vector<Closest>& places, std::vector<WallTouch>& into) {
    if constexpr (SingleContact<S>) {
        const Closest c = shape.closest(x);
        if (!(c.distance >= reach)) into.push_back({entry, {c.distance, from_shape(c.normal)}});
    } else {
        places.clear();
        shape.touching(x, reach, places);
        for (const Closest& p : places) into.push_back({entry, {p.distance, from_shape(p.normal)}});
    }
}

void refuse_flaw(const std::string& flaw) {
    if (!flaw.empty()) throw std::invalid_argument(flaw);
}

}  // namespace

std::vector<Motion> displacing(const Shape& shape, std::span<const Motion> motions) {
    bool turns = false;
    std::vector<bool> moves(motions.size(), true);
    const auto turned = [&](std::size_t k, const Vec3& point, const Vec3& axis) {
        moves[k] = turns || !std::visit([&](const auto& s) { return s.unchanged_by_turn(point, axis); }, shape);
        turns = turns || moves[k];
    };
    for (std::size_t k = 0; k < motions.size(); ++k) {
        if (const auto* r = std::get_if<Rotation>(&motions[k])) turned(k, r->point, r->axis);
        if (const auto* d = std::get_if<Drive>(&motions[k])) turned(k, d->point, d->axis);
        turns = turns || std::holds_alternative<Flight>(motions[k]);
    }
    const auto stays = [&](const Vec3& direction) {
        return !turns && std::visit([&](const auto& s) { return s.unchanged_by_shift(direction); }, shape);
    };
    std::vector<Motion> kept;
    for (std::size_t k = 0; k < motions.size(); ++k) {
        if (const auto* t = std::get_if<Translation>(&motions[k])) moves[k] = !stays(t->velocity);
        if (const auto* v = std::get_if<Vibration>(&motions[k])) moves[k] = !stays(v->amplitude);
        if (const auto* p = std::get_if<Press>(&motions[k])) moves[k] = !stays(p->along);
        if (std::holds_alternative<geometry::Conveyance>(motions[k])) moves[k] = false;
        if (moves[k]) kept.push_back(motions[k]);
    }
    return kept;
}

MovingWall::MovingWall(Wall wall, const geometry::Domain& domain, double largest, Searches searches)
    : wall_(std::move(wall)) {
    refuse_flaw(std::visit([](const auto& s) { return s.flaw(); }, wall_.shape));
    take_motions(wall_.motions);
    energy_.start = kinetic_energy(wall_.motions);
    refuse_flaw(flaw(wall_.surface, "a wall"));
    single_contact_ = std::visit([](const auto& s) { return SingleContact<decltype(s)>; }, wall_.shape);
    bounded_ = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const Extent e = std::visit([k](const auto& s) { return s.extent(k); }, wall_.shape);
        bounded_ = bounded_ && e.bounded();
        low_[k] = e.low;
        high_[k] = e.high;
        const bool has_ends =
            !std::visit([k](const auto& s) { return s.unchanged_by_shift(unit_vectors[k]); }, wall_.shape);
        if (!domain.periodic[k] || !has_ends) continue;
        body_image_.middle[k] = 0.5 * (e.low + e.high);
        body_image_.period[k] = domain.length(k);
    }
    require_possible(domain);
    found_ = with_images(domain);
    std::visit(  // a little beyond, for contacts that adhesion keeps
        [&](auto& shape) {
            if constexpr (Preparable<decltype(shape)>)
                if (largest > 0 && searches == Searches::many) shape = shape.prepared(1.05 * largest);
        },
        found_);
    thin_ = std::visit([](const auto& s) { return Thin<decltype(s)>; }, found_);
    if (!bounded_)
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] = domain.low[k] - 4 * largest;
            high_[k] = domain.high[k] + 4 * largest;
        }
    bound_speeds();
    place(0);
}

MovingWall MovingWall::moving_as(const Wall& other, const geometry::Domain& domain) const {
    if (!same_body(wall_, other))
        throw std::invalid_argument("walls that change keep their shape, surface and materials");
    MovingWall made = *this;
    made.wall_.present = other.present;
    std::vector<Motion> motions = other.motions;
    for (Motion& motion : motions) take_state(motion, wall_.motions);
    made.take_motions(std::move(motions));
    made.energy_.bounds += kinetic_energy(made.wall_.motions) - kinetic_energy(wall_.motions);
    made.require_possible(domain);
    made.bound_speeds();
    return made;
}

void MovingWall::take_motions(std::vector<Motion> motions) {
    for (const Motion& m : motions) refuse_flaw(flaw(m));
    refuse_flaw(flaw(motions));
    std::erase_if(motions, geometry::is_still);
    displacing_ = displacing(wall_.shape, motions);
    switches_ = std::ranges::any_of(displacing_, switches);
    free_ = std::ranges::any_of(motions, is_free);
    wall_.motions = std::move(motions);
}

void MovingWall::integrate(const Vec3& force, const Vec3& torque, const Vec3& about, double span) {
    integrals_.impulse += span * force;
    integrals_.angular_impulse += span * (torque + cross(about, force));
}

Vec3 MovingWall::angular_impulse(const Vec3& about) const {
    return integrals_.angular_impulse - cross(about, integrals_.impulse);
}

void MovingWall::kick(const Vec3& force, const Vec3& torque, const Vec3& about, double time, double span) {
    if (!free_) return;
    geometry::kick(wall_.motions, force, torque, about, time, span, energy_);
    displacing_ = displacing(wall_.shape, wall_.motions);
}

void MovingWall::drift(double span) {
    if (!free_) return;
    before_ = pose_;
    for (Motion& motion : wall_.motions) geometry::drift(motion, span, energy_);
    displacing_ = displacing(wall_.shape, wall_.motions);
}

void MovingWall::bound_speeds() {
    fastest_ = bound_of_speed(wall_.motions);
    fastest_surface_ = bound_of_speed(displacing_);
}

void MovingWall::require_possible(const geometry::Domain& domain) const {
    for (std::size_t k = 0; k < 3; ++k) {
        if (!domain.periodic[k]) continue;
        for (const Motion& m : displacing_) {
            const auto* r = std::get_if<Rotation>(&m);
            const auto* d = std::get_if<Drive>(&m);
            if (!turns(m) || (r != nullptr && parallel(r->axis, unit_vectors[k])) ||
                (d != nullptr && parallel(d->axis, unit_vectors[k])))
                continue;
            throw std::invalid_argument(std::string("a wall that turns about an axis across the periodic axis ") +
                                        "xyz"[k] + " has no image");
        }
        if (body_image_.period[k] == 0) continue;
        if (!std::isfinite(body_image_.middle[k]))
            throw std::invalid_argument(std::string("a wall without end must not cut the periodic axis ") + "xyz"[k]);
        const Extent e = std::visit([k](const auto& s) { return s.extent(k); }, wall_.shape);
        if (e.high - e.low > (1 + rounding_of_length) * domain.length(k))
            throw std::invalid_argument(std::string("a wall must not be longer than the period along ") + "xyz"[k]);
    }
}

/// Returns the shape with its images. A particle is transformed to the nearest image of the middle. There it can touch
/// the whole shape, and its images within half a period. No list reaches farther, because a particle would then find an
/// image of a partner twice.
Shape MovingWall::with_images(const geometry::Domain& domain) const {
    geometry::Domain around = domain;
    double margin = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        around.periodic[k] = body_image_.period[k] > 0;
        if (!around.periodic[k]) continue;
        margin = std::min(margin, body_image_.period[k] / 2);
        around.low[k] = body_image_.middle[k] - body_image_.period[k] / 2;
        around.high[k] = body_image_.middle[k] + body_image_.period[k] / 2;
    }
    return std::visit(
        [&](const auto& shape) -> Shape {
            if constexpr (Repeated<decltype(shape)>)
                if (std::isfinite(margin)) return shape.repeated(around, margin);
            return shape;
        },
        wall_.shape);
}

bool MovingWall::passed(const Pose& before, const Vec3& from, const Vec3& to) const {
    const Vec3 by = image_.of(to) - to;
    return std::visit(
        [&](const auto& shape) {
            if constexpr (Thin<decltype(shape)>)
                return static_cast<bool>(shape.crossed(before.to_body(from + by), pose_.to_body(to + by)));
            return false;
        },
        found_);
}

void MovingWall::place(double time) {
    pose_ = geometry::pose_at(displacing_, time);
    twist_ = single_contact_ || time > 0 ? twist_at(wall_.motions, time) : Twist{};
    image_ = body_image_;
    for (std::size_t k = 0; k < 3; ++k)  // turns are about this axis and leave its coordinate
        if (image_.period[k] > 0) image_.middle[k] += pose_.shift[k];
}

/// Of the box within which displacements and velocities are linear in the place, so that their extremes are here.
std::array<Vec3, 8> MovingWall::corners(const Pose& pose) const {
    std::array<Vec3, 8> all{};
    for (std::size_t c = 0; c < 8; ++c) {
        const Vec3 corner = geometry::Bounds{low_, high_}.corner(c);
        all[c] = bounded_ ? pose.from_body(corner) : corner;
    }
    return all;
}

Vec3 MovingWall::moved_since(const Pose& before) const {
    if (!pose_.turned) return pose_.shift - before.shift;
    Vec3 farthest{};
    for (const Vec3& x : corners(pose_)) {
        const Vec3 moved = x - before.from_body(pose_.to_body(x));
        if (dot(moved, moved) > dot(farthest, farthest)) farthest = moved;
    }
    return farthest;
}

geometry::Bounds MovingWall::surface_velocities(double time, double step) const {
    geometry::Bounds all = geometry::nowhere;
    const auto include_at = [&](double t) {
        const Twist twist = twist_at(displacing_, t);
        if (!twist.turns) return all.widen(twist.velocity);
        for (const Vec3& x : corners(geometry::pose_at(displacing_, t))) all.widen(twist.at(x));
    };
    include_at(time);
    if (switches_) include_at(time + step);
    return all;
}

double MovingWall::bound_of_speed(std::span<const Motion> motions) const {
    // The set of motions that act together is largest, if anywhere, where one of them starts.
    std::set<double> starts;
    for (const Motion& motion : motions) starts.insert(std::visit([](const auto& m) { return m.start; }, motion));
    double most = 0;
    for (const double time : starts) most = std::max(most, bound_of_speed_at(motions, time));
    return most;
}

double MovingWall::bound_of_speed_at(std::span<const Motion> motions, double time) const {
    Vec3 shifts{};
    double turns = 0;
    const auto farthest = [&](auto&& arm_of) {
        double arm = 0;
        for (const Vec3& x : corners(Pose{})) arm = std::max(arm, arm_of(x));
        return arm;
    };
    for (const Motion& motion : motions) {
        if (std::visit([time](const auto& m) { return time < m.start || time >= m.end; }, motion)) continue;
        const auto* r = std::get_if<Rotation>(&motion);
        const auto* t = std::get_if<Translation>(&motion);
        const auto* c = std::get_if<geometry::Conveyance>(&motion);
        const auto* v = std::get_if<Vibration>(&motion);
        const auto* p = std::get_if<Press>(&motion);
        const auto* d = std::get_if<Drive>(&motion);
        const auto* f = std::get_if<Flight>(&motion);
        for (std::size_t k = 0; k < 3; ++k) {
            if (p != nullptr) shifts[k] += p->fastest * std::abs(p->along[k]);
            if (t != nullptr) shifts[k] += std::abs(t->velocity[k]);
            if (c != nullptr) shifts[k] += std::abs(c->velocity[k]);
            if (v != nullptr) shifts[k] += std::abs(2 * std::numbers::pi * v->frequency * v->amplitude[k]);
        }
        if (r != nullptr)
            turns += std::abs(r->speed) * farthest([r](const Vec3& x) { return norm(cross(r->axis, x - r->point)); });
        if (d != nullptr)
            turns += d->fastest * farthest([d](const Vec3& x) { return norm(cross(d->axis, x - d->point)); });
        if (f != nullptr)
            turns += f->fastest + f->fastest_turn * farthest([f](const Vec3& x) { return norm(x - f->centre); });
    }
    return norm(shifts) + turns;
}

void MovingWall::find(std::span<const std::uint32_t> list, std::span<const Vec3> position,
                      const particles::Radii& radii, double beyond, std::vector<WallTouch>& into) const {
    into.clear();
    std::vector<Closest> places;
    const auto each = [&](const auto& shape, auto&& to_shape, auto&& from_shape) {
        for (std::uint32_t k = 0; k < list.size(); ++k)
            append(shape, to_shape(position[list[k]]), radii[list[k]] + beyond, k, from_shape, places, into);
    };
    std::visit([&](const auto& shape) { in_frame(shape, pose_, image_, each); }, found_);
}

void MovingWall::find(std::uint32_t entry, const Vec3& position, double reach, std::vector<WallTouch>& into) const {
    std::vector<Closest> places;
    const auto one = [&](const auto& shape, auto&& to_shape, auto&& from_shape) {
        append(shape, to_shape(position), reach, entry, from_shape, places, into);
    };
    std::visit([&](const auto& shape) { in_frame(shape, pose_, image_, one); }, found_);
}

std::optional<std::uint32_t> MovingWall::reaches(std::span<const std::uint32_t> list, std::span<const Vec3> position,
                                                 const particles::Radii& radii, double share) const {
    std::vector<WallTouch> touches;
    find(list, position, radii, 0, touches);
    for (const WallTouch& touch : touches) {
        const double radius = radii[list[touch.entry]];
        if (std::abs(touch.place.distance) < (1 - 2 * share) * radius) return touch.entry;
    }
    return std::nullopt;
}

void MovingWall::inherit(std::span<const WallTouch> before, std::span<const WallTouch> now,
                         std::vector<std::int32_t>& from) const {
    from.assign(now.size(), -1);
    if (before.empty() || now.empty()) return;
    if (single_contact_) {
        from[0] = 0;
        return;
    }
    if (before.size() == 1 && now.size() == 1) {  // nearly always
        std::uint32_t matched = no_contact;
        match_contacts({&before[0].place.normal, 1}, {&now[0].place.normal, 1}, {&matched, 1});
        from[0] = matched == no_contact ? -1 : 0;
        return;
    }
    const auto normals = [](std::span<const WallTouch> touches) {
        std::vector<Vec3> all;
        for (const WallTouch& touch : touches) all.push_back(touch.place.normal);
        return all;
    };
    std::vector<std::uint32_t> matched(now.size());
    match_contacts(normals(before), normals(now), matched);
    for (std::size_t k = 0; k < now.size(); ++k)
        if (matched[k] != no_contact) from[k] = static_cast<std::int32_t>(matched[k]);
}

}  // namespace grainsweep::dem
