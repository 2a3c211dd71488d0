#include "solver/dem/fast/clumps.hpp"

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/residual.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace grainsweep::dem::fast {

using namespace geometry;

void Clumps::append(std::span<const Body> bodies, std::size_t id) {
    BodyColumns::append(bodies, id);
    fallen.resize(size(), 0.0);
}

bool Clumps::map(Field& field, Columns& columns, const Kernels& kernels, std::size_t ids, const Scale& scale) {
    if (shapes() == 0) return true;
    constexpr std::int32_t none = -1;
    const auto n = static_cast<std::size_t>(field.count);
    columns.member.hold(n + static_cast<std::size_t>(spare));
    columns.mobility.hold(n + static_cast<std::size_t>(spare));
    std::fill_n(columns.member.data(), columns.member.capacity(), none);
    std::vector<std::int32_t> place(ids, none);
    for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(columns.id[i])] = static_cast<std::int32_t>(i);
    begin_.assign(1, 0);
    record_.clear(), body_.clear();
    for (std::size_t b = 0; b < size(); ++b) {
        for (std::size_t k = 0; k < shape_of(b).members.size(); ++k) {
            const std::size_t of = static_cast<std::size_t>(first[b]) + k;
            const std::int32_t i = of < ids ? place[of] : none;
            if (i == none || columns.member[static_cast<std::size_t>(i)] != none) return false;
            columns.member[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(record_.size());
            record_.push_back(i);
            body_.push_back(static_cast<std::int32_t>(b));
        }
        begin_.push_back(static_cast<std::int32_t>(record_.size()));
    }
    columns.bind(field);
    field.member_body = body_.data();
    for (std::size_t i = 0; i < n + fillers; ++i) {
        const float inverse = i < n ? field.records[i].inverse_mass : 1;
        field.mobility[i] = {{inverse, 0, 0, inverse, 0, inverse, 0, 0}};
    }
    batch_up(field, kernels.width, scale);
    kernels.find_mobility(field, view(scale), 0, static_cast<std::int32_t>(batches_.size()));
    return true;
}

/// Groups bodies with as many members, in order, and writes the columns by lane and by member.
void Clumps::batch_up(const Field& field, std::int32_t width, const Scale& scale) {
    batches_.clear();
    slot_place_.clear();
    for (auto* column : {&lane_mass_, &lane_inverse_mass_}) column->clear();
    for (auto* column : {&lane_single_mass_, &lane_reach_, &row_radius_, &row_inverse_radius_}) column->clear();
    for (std::size_t a = 0; a < 3; ++a) {
        lane_inverse_inertia_[a].clear(), lane_turning_[a].clear();
        row_at_[a].clear(), row_single_at_[a].clear();
    }
    for (std::size_t b = 0; b < size(); ++b) {
        const auto count = static_cast<std::int32_t>(members(b).size());
        if (batches_.empty() || batches_.back().bodies == width || batches_.back().members != count)
            batches_.push_back({static_cast<std::int32_t>(b), 0, count, 0, 0, 0});
        ++batches_.back().bodies;
    }
    const auto alike = [this](std::int32_t a, std::int32_t b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        return shape[i] == shape[j] && this->scale[i] == this->scale[j];
    };
    const ClumpBatch* shared = nullptr;  // the last one whose bodies are all alike
    for (ClumpBatch& batch : batches_) {
        batch.slot = static_cast<std::int32_t>(slot_place_.size());
        for (std::int32_t m = 0; m < batch.members; ++m)
            for (std::int32_t k = 0; k < width; ++k) {
                const auto b = static_cast<std::size_t>(batch.first + (k < batch.bodies ? k : 0));
                slot_place_.push_back(place_at(members(b)[static_cast<std::size_t>(m)]));
            }
        bool all_alike = true;
        for (std::int32_t k = 1; k < batch.bodies; ++k) all_alike = all_alike && alike(batch.first, batch.first + k);
        if (all_alike && shared != nullptr && alike(batch.first, shared->first)) {
            batch.lane = shared->lane, batch.row = shared->row;
            continue;
        }
        if (all_alike) shared = &batch;
        batch.lane = static_cast<std::int32_t>(lane_mass_.size());
        batch.row = static_cast<std::int32_t>(row_radius_.size());
        append_lanes(field, batch, width, scale);
    }
}

/// Appends what the lanes of a batch need of their bodies and members.
void Clumps::append_lanes(const Field& field, const ClumpBatch& batch, std::int32_t width, const Scale& scale) {
    const auto body_in = [&batch](std::int32_t lane) {
        return static_cast<std::size_t>(batch.first + (lane < batch.bodies ? lane : 0));
    };
    // I^-1 of the mass unit: added to 1/m in the engine's units.
    const double unit = scale.mass * scale.length * scale.length;
    for (std::int32_t k = 0; k < width; ++k) {
        const std::size_t b = body_in(k);
        const BodyShape& of = shape_of(b);
        double reach = 0;
        for (const auto& member : of.members) reach = std::max(reach, this->scale[b] * norm(member.place));
        lane_mass_.push_back(mass[b]);
        lane_inverse_mass_.push_back(inverse_mass[b]);
        lane_single_mass_.push_back(static_cast<float>(scale.mass / mass[b]));
        lane_reach_.push_back(static_cast<float>(reach / scale.length));
        for (std::size_t a = 0; a < 3; ++a) {
            lane_inverse_inertia_[a].push_back(inverse_inertia[b][a]);
            lane_turning_[a].push_back(
                of.damping == DampingMass::contact ? static_cast<float>(unit * inverse_inertia[b][a]) : 0.0F);
        }
    }
    for (std::size_t m = 0; m < static_cast<std::size_t>(batch.members); ++m)
        for (std::int32_t k = 0; k < width; ++k) {
            const std::size_t b = body_in(k);
            const Record& r = field.records[members(b)[m]];
            row_radius_.push_back(r.radius);
            row_inverse_radius_.push_back(r.inverse_radius);
            const Vec3 at = this->scale[b] * shape_of(b).members[m].place;
            for (std::size_t a = 0; a < 3; ++a) {
                row_at_[a].push_back(at[a]);
                row_single_at_[a].push_back(static_cast<float>(at[a] / scale.length));
            }
        }
}

ClumpView Clumps::view(const Scale& scale) {
    const auto numbers = [](auto& column) { return column.empty() ? nullptr : column.front().data(); };
    ClumpView v{};
    v.batches = batches_.data();
    v.position = numbers(position), v.velocity = numbers(velocity), v.momentum = numbers(momentum);
    v.orientation = numbers(orientation), v.spin_in_step = numbers(spin_in_step);
    v.fallen = fallen.data();
    v.mass = lane_mass_.data(), v.inverse_mass = lane_inverse_mass_.data();
    v.inverse_mass_single = lane_single_mass_.data(), v.reach = lane_reach_.data();
    v.place = slot_place_.data(), v.radius = row_radius_.data(), v.inverse_radius = row_inverse_radius_.data();
    v.length = scale.length, v.time = scale.time, v.force = scale.force();
    v.inverse_length = 1 / scale.length, v.inverse_speed = 1 / scale.speed();
    for (std::size_t a = 0; a < 3; ++a) {
        v.inverse_inertia[a] = lane_inverse_inertia_[a].data();
        v.turning[a] = lane_turning_[a].data();
        v.at[a] = row_at_[a].data();
        v.single_at[a] = row_single_at_[a].data();
        v.centre[a] = scale.centre[a];
        v.inverse_unit[a] = 1 / scale.unit[a];
    }
    return v;
}

void Clumps::sort(const Field& field, const Columns& columns, std::size_t ids) {
    std::vector<std::int32_t> place(ids, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(field.count); ++i)
        place[static_cast<std::size_t>(columns.id[i])] = static_cast<std::int32_t>(i);
    std::vector<std::size_t> order(size());
    for (std::size_t b = 0; b < order.size(); ++b) order[b] = b;
    std::ranges::sort(order, {},
                      [&](std::size_t b) { return std::pair(shape[b], place[static_cast<std::size_t>(first[b])]); });
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

std::pair<Vec3, Vec3> Clumps::sums(const Field& field, const Scale& scale, std::size_t b) const {
    Vec3 f{}, t{};
    const Axes now = axes(b);
    const auto of = members(b);
    for (std::size_t k = 0; k < of.size(); ++k) {
        const Force& on = field.forces[of[k]];
        const Vec3 force_on = {static_cast<double>(on.force[0]), static_cast<double>(on.force[1]),
                               static_cast<double>(on.force[2])};
        const Vec3 turn_on = {static_cast<double>(on.torque[0]), static_cast<double>(on.torque[1]),
                              static_cast<double>(on.torque[2])};
        f += force_on;
        t += cross(in_space(now, this->scale[b] * shape_of(b).members[k].place), force_on) + scale.length * turn_on;
    }
    return {scale.force() * f, scale.force() * t};
}

void Clumps::gather(const Field& field, const Scale& scale) {
    for (std::size_t b = 0; b < size(); ++b) std::tie(force[b], torque[b]) = sums(field, scale, b);
}

Clumps::Motion Clumps::motion(const Field& field, const Scale& scale, std::size_t b, double share,
                              const Vec3& acceleration) const {
    if (share == 0) return {velocity[b], momentum[b], spin_in_step[b]};
    const auto [f, t] = sums(field, scale, b);
    const double span = share * scale.time / 2;
    const Vec3 v = velocity[b] + span * (inverse_mass[b] * f + acceleration);
    const Vec3 l = momentum[b] + span * t;
    return {v, l, spin_of(l, axes(b), inverse_inertia[b])};
}

void Clumps::shift(double share, double step, const Vec3& acceleration) {
    for (std::size_t b = 0; b < size(); ++b) {
        kick_body(b, share * step, acceleration);
        spin[b] = spin_of(momentum[b], axes(b), inverse_inertia[b]);
    }
}

void Clumps::write_motions(Field& field, const Scale& scale) const {
    for (std::size_t b = 0; b < size(); ++b) {
        const Axes now = axes(b);
        const auto of = members(b);
        for (std::size_t k = 0; k < of.size(); ++k) {
            const Vec3 lever = in_space(now, this->scale[b] * shape_of(b).members[k].place);
            const Vec3 v = (1 / scale.speed()) * (velocity[b] + cross(spin[b], lever));
            Residual residual = residual_of(field, of[k]);
            for (int a = 0; a < 3; ++a) {
                const auto axis = static_cast<std::size_t>(a);
                field.records[of[k]].velocity[a] = static_cast<float>(v[axis]);
                residual.velocity[a] = 0;  // the body's velocity is exact
                set_spin(field, of[k], a, static_cast<float>(spin[b][axis] * scale.time));
            }
            leave_over(field, of[k], residual);
        }
    }
}

void Clumps::advance(Field& field, const Kernels& kernels, const Scale& scale, const Vec3& gravity,
                     const Vec3& acceleration, const Parts& parts, Tally& tally) {
    if (empty()) return;
    ClumpView of = view(scale);
    for (std::size_t a = 0; a < 3; ++a) of.gravity[a] = gravity[a], of.acceleration[a] = acceleration[a];
    tallies_.assign(static_cast<std::size_t>(parts.count()), tally);
    parts.run([&](int part) {
        const Range range = parts.share(part, static_cast<std::int32_t>(batches_.size()));
        kernels.step_clumps(field, of, range.begin, range.end, tallies_[static_cast<std::size_t>(part)]);
    });
    for (const Tally& own : tallies_)
        for (std::size_t a = 0; a < 8; ++a) {
            tally.velocity_high[a] = std::max(tally.velocity_high[a], own.velocity_high[a]);
            tally.velocity_low[a] = std::min(tally.velocity_low[a], own.velocity_low[a]);
        }
}

}  // namespace grainsweep::dem::fast
