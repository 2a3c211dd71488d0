#include "solver/dem/fast/clumps.hpp"

#include "solver/dem/fast/residual.hpp"
#include "solver/geometry/solid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

constexpr double units_of_period = 4294967296.0;

/// Returns the nearest whole number, to even; below 2^51.
double nearest(double x) {
    constexpr double shift = 6755399441055744.0;  // 1.5 * 2^52
    return (x + shift) - shift;
}

}  // namespace

Clumps::Units::Units(const Scale& scale)
    : length(scale.length),
      time(scale.time),
      inverse_length(1 / scale.length),
      inverse_speed(1 / scale.speed()),
      force(scale.mass * scale.length / (scale.time * scale.time)),
      inertia(scale.mass * scale.length * scale.length),
      centre(scale.centre),
      inverse_unit{1 / scale.unit[0], 1 / scale.unit[1], 1 / scale.unit[2]} {}

void Clumps::append(std::span<const Body> bodies, std::size_t id) {
    BodyColumns::append(bodies, id);
    fallen.resize(size(), 0.0);
}

bool Clumps::map(Field& field, Columns& columns, std::size_t ids, const Scale& scale) {
    if (shapes() == 0) return true;
    constexpr std::int32_t none = -1;
    const auto n = static_cast<std::size_t>(field.count);
    columns.member.hold(n + static_cast<std::size_t>(spare));
    std::fill_n(columns.member.data(), columns.member.capacity(), none);
    std::vector<std::int32_t> place(ids, none);
    for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(columns.id[i])] = static_cast<std::int32_t>(i);
    begin_.assign(1, 0);
    record_.clear(), body_.clear(), place_.clear(), lever_.clear();
    bool all = true;
    for (std::size_t b = 0; b < size(); ++b) {
        for (std::size_t k = 0; k < shape_of(b).members.size(); ++k) {
            const std::size_t of = static_cast<std::size_t>(first[b]) + k;
            const std::int32_t i = of < ids ? place[of] : none;
            if (i == none || columns.member[static_cast<std::size_t>(i)] != none) {
                all = false;
                continue;
            }
            columns.member[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(record_.size());
            record_.push_back(i);
            body_.push_back(static_cast<std::int32_t>(b));
            place_.push_back(this->scale[b] * shape_of(b).members[k].place);
            lever_.push_back(in_space(axes[b], place_.back()));
        }
        begin_.push_back(static_cast<std::int32_t>(record_.size()));
    }
    arms_.assign(record_.size() + 1, MemberArm{});
    const Units units(scale);
    for (std::size_t b = 0; all && b < size(); ++b) set_arms(b, units);
    field.member = columns.member.data();
    field.arms = arms_.data();
    field.member_body = body_.data();
    return all;
}

void Clumps::sort(const Field& field, const Columns& columns, std::size_t ids) {
    std::vector<std::int32_t> place(ids, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(field.count); ++i)
        place[static_cast<std::size_t>(columns.id[i])] = static_cast<std::int32_t>(i);
    std::vector<std::size_t> order(size());
    for (std::size_t b = 0; b < order.size(); ++b) order[b] = b;
    std::ranges::sort(order, {}, [&](std::size_t b) { return place[static_cast<std::size_t>(first[b])]; });
    const auto permute = [&](auto& column) {
        auto fresh = column;
        for (std::size_t b = 0; b < order.size(); ++b) fresh[b] = column[order[b]];
        column.swap(fresh);
    };
    for_each_column(*this, permute);
    permute(fallen);
    derive();
}

void Clumps::take_out(const geometry::Domain& domain, std::vector<std::int32_t>& removed) {
    if (empty()) return;
    std::vector<std::int32_t> sorted = removed;
    std::ranges::sort(sorted);
    std::vector<bool> leaving(size(), false);
    bool any = false;
    for (std::size_t b = 0; b < size(); ++b) {
        position[b] += domain.wrapping(position[b]);
        const auto count = static_cast<std::int32_t>(shape_of(b).members.size());
        const auto named = std::ranges::lower_bound(sorted, first[b]);
        leaving[b] = domain.outside(position[b]) || (named != sorted.end() && *named < first[b] + count);
        if (!leaving[b]) continue;
        any = true;
        for (std::int32_t k = 0; k < count; ++k) removed.push_back(first[b] + k);
    }
    if (!any) return;
    std::size_t kept = 0;
    for (std::size_t b = 0; b < fallen.size(); ++b)
        if (!leaving[b]) fallen[kept++] = fallen[b];
    fallen.resize(kept);
    remove(leaving);
}

std::pair<Vec3, Vec3> Clumps::sums(const Field& field, double force_unit, double length, std::size_t b) const {
    Vec3 f{}, t{};
    for (auto slot = static_cast<std::size_t>(begin_[b]); slot < static_cast<std::size_t>(begin_[b + 1]); ++slot) {
        const Force& on = field.forces[record_[slot]];
        const Vec3 force_on = {static_cast<double>(on.force[0]), static_cast<double>(on.force[1]),
                               static_cast<double>(on.force[2])};
        const Vec3 turn_on = {static_cast<double>(on.torque[0]), static_cast<double>(on.torque[1]),
                              static_cast<double>(on.torque[2])};
        f += force_on;
        t += cross(lever_[slot], force_on) + length * turn_on;
    }
    return {force_unit * f, force_unit * t};
}

void Clumps::gather(const Field& field, const Scale& scale) {
    const Units units(scale);
    for (std::size_t b = 0; b < size(); ++b) std::tie(force[b], torque[b]) = sums(field, units.force, units.length, b);
}

Clumps::Motion Clumps::motion(const Field& field, const Scale& scale, std::size_t b, double share,
                              const Vec3& acceleration) const {
    if (share == 0) return {velocity[b], momentum[b], spin_in_step[b]};
    const Units units(scale);
    const auto [f, t] = sums(field, units.force, units.length, b);
    const double span = share * scale.time / 2;
    const Vec3 v = velocity[b] + span * (inverse_mass[b] * f + acceleration);
    const Vec3 l = momentum[b] + span * t;
    return {v, l, spin_of(l, axes[b], inverse_inertia[b])};
}

void Clumps::shift(double share, double step, const Vec3& acceleration) {
    for (std::size_t b = 0; b < size(); ++b) {
        kick_body(b, share * step, acceleration);
        spin[b] = spin_of(momentum[b], axes[b], inverse_inertia[b]);
    }
}

void Clumps::set_arms(std::size_t b, const Units& units) {
    // I^-1 of the mass unit: added to 1/m in the engine's units.
    const double unit = shape_of(b).damping == DampingMass::body ? 0 : units.inertia;
    Inertia inverse{};
    for (std::size_t k = 0; k < 3; ++k) add_square(inverse, axes[b][k], unit * inverse_inertia[b][k]);
    for (auto slot = static_cast<std::size_t>(begin_[b]); slot < static_cast<std::size_t>(begin_[b + 1]); ++slot) {
        MemberArm& arm = arms_[slot];
        for (std::size_t a = 0; a < 3; ++a) arm.lever[a] = static_cast<float>(lever_[slot][a] * units.inverse_length);
        for (std::size_t c = 0; c < 6; ++c) arm.inverse_inertia[c] = static_cast<float>(inverse[c]);
    }
}

void Clumps::write_motion(Field& field, const Units& units, std::size_t b, std::size_t slot) const {
    const std::int32_t i = record_[slot];
    const Vec3 v = units.inverse_speed * (velocity[b] + cross(spin[b], lever_[slot]));
    Record& r = field.records[i];
    Residual& residual = field.residuals[i];
    for (std::size_t a = 0; a < 3; ++a) {
        r.velocity[a] = static_cast<float>(v[a]);
        residual.velocity[a] = static_cast<float>(v[a] - static_cast<double>(r.velocity[a]));
        r.spin[a] = static_cast<float>(spin[b][a] * units.time);
        r.rest[a] = r.spin[a] * r.radius;
    }
}

void Clumps::write_motions(Field& field, const Scale& scale) const {
    const Units units(scale);
    for (std::size_t b = 0; b < size(); ++b)
        for (std::int32_t slot = begin_[b]; slot < begin_[b + 1]; ++slot)
            write_motion(field, units, b, static_cast<std::size_t>(slot));
}

void Clumps::place_members(Field& field, const Units& units, const Vec3& moved, std::size_t b, Tally& tally) {
    const Vec3 x_body = position[b], v_body = velocity[b], w = spin[b];
    const Axes axes_now = axes[b];
    std::array<float, 3> high{}, low{}, single_spin{};
    for (std::size_t a = 0; a < 3; ++a) {
        high[a] = tally.velocity_high[a], low[a] = tally.velocity_low[a];
        single_spin[a] = static_cast<float>(w[a] * units.time);
        tally.velocity_high[4 + a] = std::max(tally.velocity_high[4 + a], single_spin[a]);
        tally.velocity_low[4 + a] = std::min(tally.velocity_low[4 + a], single_spin[a]);
    }
    for (auto slot = static_cast<std::size_t>(begin_[b]); slot < static_cast<std::size_t>(begin_[b + 1]); ++slot) {
        const std::int32_t i = record_[slot];
        const Vec3 before = lever_[slot], lever = in_space(axes_now, place_[slot]);
        lever_[slot] = lever;
        const Vec3 x = x_body + lever, v = units.inverse_speed * (v_body + cross(w, lever));
        const Vec3 way = units.inverse_length * (moved + (lever - before));
        Record& r = field.records[i];
        Residual& residual = field.residuals[i];
        for (std::size_t a = 0; a < 3; ++a) {
            double at = (x[a] - units.centre[a]) * units.inverse_unit[a];
            // On open axes only far outside, whence the next rebuild takes it out.
            at -= units_of_period * nearest(at * (1 / units_of_period));
            const double whole = nearest(at);
            r.position[a] = static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(whole)));
            residual.position[a] = static_cast<float>(at - whole);
            const auto single = static_cast<float>(v[a]), single_way = static_cast<float>(way[a]);
            r.velocity[a] = single;
            residual.velocity[a] = static_cast<float>(v[a] - static_cast<double>(single));
            r.spin[a] = single_spin[a];
            r.rest[a] = single_spin[a] * r.radius;
            high[a] = std::max(high[a], std::max(single, single_way));
            low[a] = std::min(low[a], std::min(single, single_way));
        }
        field.forces[i] = Force{};
    }
    for (std::size_t a = 0; a < 3; ++a) tally.velocity_high[a] = high[a], tally.velocity_low[a] = low[a];
    set_arms(b, units);
}

/// Fetches what the bodies behind this one write.
void Clumps::fetch(const Field& field, std::int32_t body) const {
    const auto end = std::min(static_cast<std::size_t>(body + TurningClumps::lanes), size());
    for (auto b = static_cast<std::size_t>(body); b < end; ++b)
        for (const std::int32_t i : members(b)) {
            __builtin_prefetch(field.records + i, 1);
            __builtin_prefetch(field.residuals + i, 1);
            __builtin_prefetch(field.forces + i, 1);
        }
}

/// Steps a few bodies, whose rotations are computed together.
void Clumps::step(Field& field, const Kernels& kernels, const Units& units, const Vec3& gravity,
                  const Vec3& acceleration, Range bodies, Tally& tally) {
    fetch(field, bodies.end);
    TurningClumps t{};
    std::array<Vec3, TurningClumps::lanes> moved{};
    for (std::int32_t n = bodies.begin; n < bodies.end; ++n) {
        const auto b = static_cast<std::size_t>(n), k = static_cast<std::size_t>(n - bodies.begin);
        std::tie(force[b], torque[b]) = sums(field, units.force, units.length, b);
        kick_body(b, units.time, acceleration);
        moved[k] = units.time * velocity[b];
        position[b] += moved[k];
        fallen[b] += mass[b] * dot(gravity, moved[k]);
        for (std::size_t a = 0; a < 3; ++a) t.momentum[a][k] = momentum[b][a], t.inverse[a][k] = inverse_inertia[b][a];
        for (std::size_t a = 0; a < 4; ++a) t.orientation[a][k] = orientation[b][a];
    }
    kernels.turn(t, units.time);
    for (std::int32_t n = bodies.begin; n < bodies.end; ++n) {
        const auto b = static_cast<std::size_t>(n), k = static_cast<std::size_t>(n - bodies.begin);
        for (std::size_t a = 0; a < 4; ++a) orientation[b][a] = t.orientation[a][k];
        for (std::size_t a = 0; a < 3; ++a) {
            spin[b][a] = spin_in_step[b][a] = t.spin[a][k];
            for (std::size_t e = 0; e < 3; ++e) axes[b][e][a] = t.axes[e][a][k];
        }
        place_members(field, units, moved[k], b, tally);
    }
}

void Clumps::advance(Field& field, const Kernels& kernels, const Scale& scale, const Vec3& gravity,
                     const Vec3& acceleration, const Parts& parts, Tally& tally) {
    if (empty()) return;
    const Units units(scale);
    tallies_.assign(static_cast<std::size_t>(parts.count()), tally);
    parts.run([&](int part) {
        const Range range = parts.share(part, static_cast<std::int32_t>(size()), TurningClumps::lanes);
        Tally own = tally;
        for (std::int32_t b = range.begin; b < range.end; b += TurningClumps::lanes)
            step(field, kernels, units, gravity, acceleration, {b, std::min(b + TurningClumps::lanes, range.end)}, own);
        tallies_[static_cast<std::size_t>(part)] = own;
    });
    for (const Tally& own : tallies_)
        for (std::size_t a = 0; a < 8; ++a) {
            tally.velocity_high[a] = std::max(tally.velocity_high[a], own.velocity_high[a]);
            tally.velocity_low[a] = std::min(tally.velocity_low[a], own.velocity_low[a]);
        }
}

}  // namespace grainsweep::dem::fast
