#include "solver/dem/fast/watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/dem/limits.hpp"
#include "solver/dem/shaking.hpp"
#include "solver/geometry/vector.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

/// Whether a record moves with a clump.
bool is_member(const Field& field, std::int32_t i) {
    return field.member != nullptr && field.member[i] >= 0;
}

}  // namespace

Watch::Watch(const Setup& setup, const Scale& scale)
    : gravity_(setup.gravity),
      domain_(setup.domain),
      speed_unit_(scale.speed()),
      energy_unit_(scale.mass * scale.speed() * scale.speed()),
      shaking_speed_(fastest(setup.shaking)),
      balanced_(is_still(setup.shaking)),
      seen_(setup.spheres.size()) {
    for (std::size_t a = 0; a < 3; ++a)
        if (domain_.periodic[a] && gravity_[a] != 0)
            quarter_period_ = std::min(quarter_period_, domain_.length(a) / scale.length / 4);
}

double Watch::kinetic(const Moment& now) const {
    const Scale& s = now.space.scale;
    double energy = now.of_clumps;
    for (std::int32_t i = 0; i < now.field.count; ++i) {
        const Record& r = now.field.records[i];
        if (!(r.inverse_mass > 0) || is_member(now.field, i)) continue;
        const Velocities& m = now.motions[static_cast<std::size_t>(i)];
        const double mass = s.mass / static_cast<double>(r.inverse_mass);
        const double radius = static_cast<double>(r.radius) * s.length;
        energy += mass * (0.5 * dot(m.velocity, m.velocity) + 0.2 * radius * radius * dot(m.spin, m.spin));
    }
    return energy;
}

/// Adds the work of gravity since the last check.
void Watch::add_gravity_work(const Moment& now) {
    const Scale& s = now.space.scale;
    double work = now.fallen;
    for (std::int32_t i = 0; i < now.field.count; ++i) {
        const Record& r = now.field.records[i];
        Place3& seen = seen_[static_cast<std::size_t>(now.id[i])];
        if (r.inverse_mass > 0 && !is_member(now.field, i)) {
            Vec3 moved{};
            for (std::size_t a = 0; a < 3; ++a)
                moved[a] = static_cast<std::int32_t>(static_cast<std::uint32_t>(r.position[a]) -
                                                     static_cast<std::uint32_t>(seen[a])) *
                           s.unit[a];
            work += s.mass / static_cast<double>(r.inverse_mass) * dot(gravity_, moved);
        }
        std::copy(r.position, r.position + 3, seen.begin());
    }
    work_of_gravity_ += work;
    covered_ = 0;
}

void Watch::set_limit(const Moment& now, std::span<const MovingWall> walls) {
    double start = 0, lightest = std::numeric_limits<double>::infinity(), wall = 0, free_fall = 0;
    for (std::int32_t i = 0; i < now.field.count; ++i) {
        const Record& r = now.field.records[i];
        if (!(r.inverse_mass > 0)) continue;
        const Velocities& m = now.motions[static_cast<std::size_t>(i)];
        const double radius = static_cast<double>(r.radius) * now.space.scale.length;
        start = std::max({start, norm(m.velocity), radius * norm(m.spin)});
        lightest = std::min(lightest, now.space.scale.mass / static_cast<double>(r.inverse_mass));
    }
    for (const MovingWall& w : walls)
        if (w.present()) wall = std::max(wall, w.fastest());
    for (std::size_t a = 0; a < 3; ++a)  // through the domain; without limit along a periodic axis
        if (gravity_[a] != 0)
            free_fall = domain_.periodic[a]
                            ? std::numeric_limits<double>::infinity()
                            : std::hypot(free_fall, std::sqrt(2 * std::abs(gravity_[a]) * domain_.length(a)));
    const double active = kinetic(now) + now.stored.squeezed;
    const double released = std::isfinite(lightest) ? std::sqrt(2 * active / lightest) : 0;
    speed_limit_ = largest_sound_speed_factor * (start + wall + shaking_speed_ + free_fall + released);
    add_gravity_work(now);
    restart_balance();
}

void Watch::add_travel(double fastest_component) {
    covered_ += std::numbers::sqrt3 * fastest_component;
}

bool Watch::too_fast(double fastest_component) const {
    return std::numbers::sqrt3 * fastest_component * speed_unit_ > speed_limit_;
}

bool Watch::due(std::int64_t steps) const {
    const std::int64_t interval = spheres() > few_particles ? energy_interval : energy_interval_of_few;
    return balanced_ && (steps % interval == 0 || covered_ > quarter_period_);
}

std::string Watch::check(const Moment& now, std::int32_t& particle) {
    add_gravity_work(now);
    const double motion = kinetic(now);
    const auto flaw = balance_.flaw({.steps = now.steps,
                                     .balance = motion + now.stored.sum - work_of_gravity_ - work_of_walls_,
                                     .active = motion + now.stored.squeezed,
                                     .walls = work_of_walls_});
    if (!flaw) return {};
    double most = -1;
    for (std::int32_t i = 0; i < now.field.count; ++i)
        if (const double speed = norm(now.motions[static_cast<std::size_t>(i)].velocity); !(speed <= most))
            most = speed, particle = i;
    return *flaw;
}

}  // namespace grainsweep::dem::fast
