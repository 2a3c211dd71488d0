#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/dem/fast/mixed_stepping.hpp"
#include "solver/dem/fast/residual.hpp"

namespace grainsweep::dem::fast {

namespace {

constexpr double rounding_of_overlaps = 4e-7;  // of the distance: measured in beds under shear

/// Returns the indices in order of id. Ids have gaps only for removed particles, so counting is faster than sorting.
std::vector<std::int32_t> by_id(std::span<const std::int32_t> ids) {
    constexpr std::int32_t none = -1;
    const auto last = std::ranges::max_element(ids);
    std::vector<std::int32_t> index(last == ids.end() ? 0 : static_cast<std::size_t>(*last) + 1, none);
    for (std::size_t i = 0; i < ids.size(); ++i) index[static_cast<std::size_t>(ids[i])] = static_cast<std::int32_t>(i);
    std::erase(index, none);
    return index;
}

}  // namespace

void MixedEngine::state(State& into) const {
    const auto n = size();
    into.bodies.clear();
    std::vector<Clumps::Motion> full;
    for (std::size_t b = 0; b < clumps_.size(); ++b) {
        full.push_back(clumps_.motion(field_, space_.scale, b, 1, acceleration_));
        BodyState state = clumps_.state(b);
        state.velocity = full[b].velocity, state.angular_velocity = full[b].spin;
        state.angular_momentum = full[b].momentum;
        into.bodies.push_back(state);
    }
    std::ranges::sort(into.bodies, {}, &BodyState::first);
    into.id.resize(n);
    into.position.resize(n), into.velocity.resize(n), into.angular_velocity.resize(n);
    into.radius.resize(n), into.mobile.resize(n);
    const std::vector<std::int32_t> order = by_id({columns_.id.data(), n});
    const Scale& s = space_.scale;
    for (std::size_t k = 0; k < n; ++k) {
        const std::int32_t i = order[k];
        const Record& r = field_.records[i];
        const Residual residual = residual_of(field_, i);
        into.id[k] = columns_.id[static_cast<std::size_t>(i)];
        into.radius[k] = static_cast<double>(r.radius) * s.length;
        into.mobile[k] = r.inverse_mass > 0 ? 1 : 0;
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            double x = s.centre[axis] + (r.position[a] + static_cast<double>(residual.position[a])) * s.unit[axis];
            if (space_.domain.periodic[axis]) {
                const double low = space_.domain.low[axis], period = space_.domain.high[axis] - low;
                if (x < low) x += period;
                if (x >= space_.domain.high[axis]) x -= period;
            }
            into.position[k][axis] = x;
            into.velocity[k][axis] =
                (static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) + half_change(i, a)) *
                s.speed();
            into.angular_velocity[k][axis] = (static_cast<double>(r.spin[a]) + half_spin_change(i, a)) / s.time;
        }
        if (const std::int32_t body = clumps_.body_of(field_, i); body >= 0) {
            const Clumps::Motion& m = full[static_cast<std::size_t>(body)];
            into.velocity[k] = geometry::operator+(m.velocity, geometry::cross(m.spin, clumps_.lever_at(field_, i)));
            into.angular_velocity[k] = m.spin;
        }
    }
}

/// Velocities in the order of the records: of the half step before, and a share of the half step to the full one.
std::vector<Velocities> MixedEngine::motions(double share) const {
    std::vector<Velocities> all(size());
    for (std::int32_t i = 0; i < field_.count; ++i) {
        const Record& r = field_.records[i];
        const Residual residual = residual_of(field_, i);
        Velocities& m = all[static_cast<std::size_t>(i)];
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            m.velocity[axis] = (static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) +
                                share * half_change(i, a)) *
                               space_.scale.speed();
            m.spin[axis] = (static_cast<double>(r.spin[a]) + share * half_spin_change(i, a)) / space_.scale.time;
        }
    }
    for (std::size_t b = 0; b < clumps_.size(); ++b) {
        const Clumps::Motion m = clumps_.motion(field_, space_.scale, b, share, acceleration_);
        const auto members = clumps_.members(b);
        for (std::size_t k = 0; k < members.size(); ++k)
            all[static_cast<std::size_t>(members[k])] = {
                geometry::operator+(m.velocity, geometry::cross(m.spin, clumps_.lever_of(b, k))), m.spin};
    }
    return all;
}

void MixedEngine::read_contacts(std::span<const Velocities> before, std::vector<ContactForce>& into) const {
    join_lists();
    const std::vector<Velocities> now = motions();
    // By `spring` a force jumps where its spring is cut, so that the reader must find every spring that the step cut.
    const bool jumps = std::ranges::any_of(
        materials_, [](const Material& m) { return m.tangential_limit == TangentialLimit::spring; });
    const ContactReader reader(laws_, space_, field_, columns_.id.data(), now, kernels_->width, resting_.parked(),
                               before, &clumps_, jumps ? rounding_of_overlaps : 0);
    into.clear();
    reader.pairs(into);
    for (std::size_t w = 0; w < walls_.count(); ++w) reader.wall(walls_, w, into);
}

WallLoad MixedEngine::wall_load(std::size_t wall, const Vec3& about) const {
    return walls_.load(wall, about);
}

Moment MixedEngine::moment(std::span<const Velocities> motions) const {
    join_lists();
    const ContactReader reader(laws_, space_, field_, columns_.id.data(), {}, kernels_->width, resting_.parked());
    Moment now{field_, space_, columns_.id.data(), motions, reader.stored(walls_), work_.steps, 0, 0};
    for (std::size_t b = 0; b < clumps_.size(); ++b) {
        const Clumps::Motion m = clumps_.motion(field_, space_.scale, b, 1, acceleration_);
        now.of_clumps += clumps_.kinetic_energy(b, m.velocity, m.momentum);
        now.fallen += clumps_.fallen[b];
    }
    return now;
}

void MixedEngine::set_limits() {
    const std::vector<Velocities> now = motions();
    watch_.set_limit(moment(now), walls_.all());
    std::ranges::fill(clumps_.fallen, 0.0);
    if (fault_.empty() && field_.count > 0)
        fault_ = walls_.too_fast(0.5 * static_cast<double>(smallest_diameter_) * space_.scale.length, work_.steps);
}

void MixedEngine::check_energy() {
    const std::vector<Velocities> now = motions();
    std::int32_t particle = 0;
    const std::string what = watch_.check(moment(now), particle);
    std::ranges::fill(clumps_.fallen, 0.0);
    if (!what.empty()) fault_ = describe(view(), what, particle);
}

}  // namespace grainsweep::dem::fast
