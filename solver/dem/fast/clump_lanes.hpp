// Step of clumps, one in each lane: sums of the forces on their members, kick, drift and turn as in
// solver/dem/body.hpp, and the members' new records. State of bodies is in double precision and SI. Lanes without a
// body repeat the first one of their batch, and so write the same bits to the same places.
//
// A contact along n of a member with the lever r from the centre of mass has
//
//     1/m_c = 1/m + (r x n) I^-1 (r x n) = n M n,   M = 1/m + [r]^T I^-1 [r],  [r] n = r x n,
//
// so that a pair needs only the sum of both matrices M. The files of the instruction paths include this file; it has
// internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

GRAINSWEEP_LANES V3 load(const float* const (&rows)[3], std::int64_t at) {
    return {load(rows[0] + at), load(rows[1] + at), load(rows[2] + at)};
}
GRAINSWEEP_LANES D3 load(const double* const (&rows)[3], std::int64_t at) {
    return {load(rows[0] + at), load(rows[1] + at), load(rows[2] + at)};
}
// ---- state of bodies: a few numbers each, one body after the other

/// Loads `n` numbers of each body of a batch.
template <int n>
GRAINSWEEP_LANES void load_bodies(const double* column, const ClumpBatch& b, D* rows) {
    double few[n * width];
    const double* from = column + std::int64_t{n} * b.first;
    if (b.bodies < width) {
        for (int k = 0; k < width; ++k)
            for (int a = 0; a < n; ++a) few[n * k + a] = from[n * (k < b.bodies ? k : 0) + a];
        from = few;
    }
    const double* const upper = from + n * width / 2;
    if constexpr (n == 1) {
        rows[0] = load(from);
    } else if constexpr (n == 3) {
        hn::LoadInterleaved3(doubles, from, rows[0].lo, rows[1].lo, rows[2].lo);
        hn::LoadInterleaved3(doubles, upper, rows[0].hi, rows[1].hi, rows[2].hi);
    } else {
        hn::LoadInterleaved4(doubles, from, rows[0].lo, rows[1].lo, rows[2].lo, rows[3].lo);
        hn::LoadInterleaved4(doubles, upper, rows[0].hi, rows[1].hi, rows[2].hi, rows[3].hi);
    }
}
template <int n>
GRAINSWEEP_LANES void store_bodies(double* column, const ClumpBatch& b, const D* rows) {
    double few[n * width];
    double* const own = column + std::int64_t{n} * b.first;
    double* const to = b.bodies < width ? few : own;
    double* const upper = to + n * width / 2;
    if constexpr (n == 1) {
        hn::StoreU(rows[0].lo, doubles, to);
        hn::StoreU(rows[0].hi, doubles, upper);
    } else if constexpr (n == 3) {
        hn::StoreInterleaved3(rows[0].lo, rows[1].lo, rows[2].lo, doubles, to);
        hn::StoreInterleaved3(rows[0].hi, rows[1].hi, rows[2].hi, doubles, upper);
    } else {
        hn::StoreInterleaved4(rows[0].lo, rows[1].lo, rows[2].lo, rows[3].lo, doubles, to);
        hn::StoreInterleaved4(rows[0].hi, rows[1].hi, rows[2].hi, rows[3].hi, doubles, upper);
    }
    if (to == few)
        for (int k = 0; k < n * b.bodies; ++k) own[k] = few[k];
}
GRAINSWEEP_LANES D3 load_vectors(const double* column, const ClumpBatch& b) {
    D rows[3];
    load_bodies<3>(column, b, rows);
    return {rows[0], rows[1], rows[2]};
}
GRAINSWEEP_LANES void store_vectors(double* column, const ClumpBatch& b, D3 a) {
    const D rows[3] = {a.x, a.y, a.z};
    store_bodies<3>(column, b, rows);
}

// ---- rotation

struct LaneQuaternion {
    D w, x, y, z;
};
struct LaneAxes {
    D3 of[3];
};

GRAINSWEEP_LANES LaneAxes axes_of(const LaneQuaternion& q) {
    const auto [w, x, y, z] = q;
    const D one = broadcast(1.0), two = broadcast(2.0), xx = x * x, yy = y * y, zz = z * z;
    const D wx = w * x, wy = w * y, wz = w * z, xy = x * y, xz = x * z, yz = y * z;
    return {{{fnma(two, yy + zz, one), two * (xy + wz), two * (xz - wy)},
             {two * (xy - wz), fnma(two, xx + zz, one), two * (yz + wx)},
             {two * (xz + wy), two * (yz - wx), fnma(two, xx + yy, one)}}};
}
/// Returns a vector of the bodies' frames in space.
GRAINSWEEP_LANES D3 in_space(const LaneAxes& axes, D3 a) {
    return fma(axes.of[0], a.x, fma(axes.of[1], a.y, axes.of[2] * a.z));
}
GRAINSWEEP_LANES D3 spin_of(const LaneAxes& axes, D3 momentum, D3 inverse) {
    return in_space(axes, {inverse.x * dot(axes.of[0], momentum), inverse.y * dot(axes.of[1], momentum),
                           inverse.z * dot(axes.of[2], momentum)});
}
/// Returns 1/sqrt(1 + e): the first terms of its series, and Newton's iteration to the last digit below 0.2.
GRAINSWEEP_LANES D inverse_root_beside_one(D e) {
    const D half = broadcast(0.5), one_and_half = broadcast(1.5), half_square = fma(half, e, half);
    D y = fma(e, fma(e, fnma(broadcast(0.3125), e, broadcast(0.375)), broadcast(-0.5)), broadcast(1.0));
    for (int iteration = 0; iteration < 2; ++iteration) y = y * fnma(half_square * y, y, one_and_half);
    return y;
}
/// Returns w q.
GRAINSWEEP_LANES LaneQuaternion rate_of(const LaneQuaternion& q, D3 w) {
    const D none = broadcast(0.0);
    return {fnma(w.x, q.x, fnma(w.y, q.y, fnma(w.z, q.z, none))), fma(q.w, w.x, fma(w.y, q.z, fnma(w.z, q.y, none))),
            fma(q.w, w.y, fma(w.z, q.x, fnma(w.x, q.z, none))), fma(q.w, w.z, fma(w.x, q.y, fnma(w.y, q.x, none)))};
}
/// Returns q + part w q of unit length: it is sqrt(1 + part^2 w^2) long.
GRAINSWEEP_LANES LaneQuaternion moved_on(const LaneQuaternion& q, const LaneQuaternion& rate, D square, double part) {
    const D length = inverse_root_beside_one(square * broadcast(part * part)), p = broadcast(part);
    return {length * fma(p, rate.w, q.w), length * fma(p, rate.x, q.x), length * fma(p, rate.y, q.y),
            length * fma(p, rate.z, q.z)};
}
/// Advances orientations; returns the angular velocity of the middle of the step (turn() in solver/dem/body.hpp).
GRAINSWEEP_LANES D3 turn(LaneQuaternion& q, const LaneAxes& axes, D3 momentum, D3 inverse, double span) {
    const D3 start = spin_of(axes, momentum, inverse);
    const LaneQuaternion at_start = rate_of(q, start);
    const D square = dot(start, start);
    const LaneQuaternion whole = moved_on(q, at_start, square, span / 2),
                         middle = moved_on(q, at_start, square, span / 4);
    const D3 spin = spin_of(axes_of(middle), momentum, inverse);
    const LaneQuaternion halves = moved_on(middle, rate_of(middle, spin), dot(spin, spin), span / 4);
    const D w = halves.w + halves.w - whole.w, x = halves.x + halves.x - whole.x, y = halves.y + halves.y - whole.y,
            z = halves.z + halves.z - whole.z;
    const D length = inverse_root_beside_one(fma(w, w, fma(x, x, fma(y, y, fma(z, z, broadcast(-1.0))))));
    q = {length * w, length * x, length * y, length * z};
    return spin;
}

// ---- members

/// Extremes of velocities and spins in all lanes.
struct LaneExtremes {
    F high[6], low[6];

    GRAINSWEEP_LANES explicit LaneExtremes(const Tally& t) {
        for (int a = 0; a < 3; ++a) {
            high[a] = broadcast(t.velocity_high[a]), high[3 + a] = broadcast(t.velocity_high[4 + a]);
            low[a] = broadcast(t.velocity_low[a]), low[3 + a] = broadcast(t.velocity_low[4 + a]);
        }
    }
    GRAINSWEEP_LANES void include(int from, V3 v, F slack) {
        const F of[3] = {v.x, v.y, v.z};
        for (int a = 0; a < 3; ++a) {
            high[from + a] = max(of[a] + slack, high[from + a]);
            low[from + a] = min(of[a] - slack, low[from + a]);
        }
    }
    GRAINSWEEP_LANES void add_to(Tally& t) const {
        for (int a = 0; a < 6; ++a) {
            const int to = a < 3 ? a : a + 1;
            t.velocity_high[to] = largest(high[a]);
            t.velocity_low[to] = hn::GetLane(hn::MinOfLanes(singles, low[a].v));
        }
    }
};

/// Position in units: the nearest whole number modulo 2^32, which wraps periodic axes, and the rest. On open axes only
/// what lies far outside wraps, whence the next rebuild takes it out.
struct InUnits {
    F whole;  ///< bits of the integer
    F rest;
};
GRAINSWEEP_LANES InUnits in_units(D at) {
    const D shift = broadcast(6755399441055744.0);  // 1.5 * 2^52: the last 32 bits of the sum are the integer's
    const D shifted = at + shift;
    const auto whole = hn::ConcatEven(integers, hn::BitCast(integers, shifted.hi), hn::BitCast(integers, shifted.lo));
    return {{hn::BitCast(singles, whole)}, single(at - (shifted - shift))};
}

/// Writes M of the members of a batch.
GRAINSWEEP_PHASE void write_mobility(const Field& f, const ClumpView& c, const ClumpBatch& b, const V3 (&axes)[3]) {
    F inverse[6] = {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f),
                    broadcast(0.0f), broadcast(0.0f), broadcast(0.0f)};
    for (int k = 0; k < 3; ++k) {
        const V3 e = axes[k], s = e * load(c.turning[k] + b.lane);
        inverse[0] = fma(s.x, e.x, inverse[0]), inverse[1] = fma(s.x, e.y, inverse[1]);
        inverse[2] = fma(s.x, e.z, inverse[2]), inverse[3] = fma(s.y, e.y, inverse[3]);
        inverse[4] = fma(s.y, e.z, inverse[4]), inverse[5] = fma(s.z, e.z, inverse[5]);
    }
    const V3 row[3] = {{inverse[0], inverse[1], inverse[2]},
                       {inverse[1], inverse[3], inverse[4]},
                       {inverse[2], inverse[4], inverse[5]}};
    const F zero = broadcast(0.0f);
    for (std::int64_t slot = b.slot, k = 0; k < b.members; ++k, slot += width) {
        const V3 at = load(c.single_at, b.row + k * width);
        const V3 r = fma(axes[0], at.x, fma(axes[1], at.y, axes[2] * at.z));
        // I^-1 [r] has rows i x r, and [r]^T times it has columns (column) x r.
        const V3 i0 = cross(row[0], r), i1 = cross(row[1], r), i2 = cross(row[2], r);
        const V3 m0 = cross({i0.x, i1.x, i2.x}, r), m1 = cross({i0.y, i1.y, i2.y}, r),
                 m2 = cross({i0.z, i1.z, i2.z}, r);
        const F own = load(c.inverse_mass_single + b.lane);
        const F first[4] = {own + m0.x, m1.x, m2.x, own + m1.y}, second[4] = {m2.y, own + m2.z, zero, zero};
        F8 out[width];
        to_eights(first, second, out);
        for (int q = 0; q < width; ++q) store8(f.mobility[c.place[slot + q] / places_per_index].of, out[q]);
    }
}

/// Fetches what the step of a batch reads and writes.
GRAINSWEEP_LANES void fetch(const Field& f, const ClumpView& c, const ClumpBatch& b) {
    const auto fetch_bodies = [&b](const double* column, int numbers) {
        const double* const from = column + std::int64_t{numbers} * b.first;
        for (int k = 0; k < numbers * b.bodies; k += cache_line / 8) prefetch_to_write(from + k);
    };
    for (double* column : {c.position, c.velocity, c.momentum, c.spin_in_step}) fetch_bodies(column, 3);
    fetch_bodies(c.orientation, 4);
    fetch_bodies(c.fallen, 1);
    for (std::int64_t slot = b.slot; slot < b.slot + std::int64_t{b.members} * width; ++slot) {
        const Place p = c.place[slot];
        prefetch_to_write(force_at(f.forces, p));
        prefetch_to_write(record_at(f.records, p));
        if (f.residuals != nullptr) prefetch_to_write(f.residuals + p / places_per_index);
        prefetch_to_write(f.mobility + p / places_per_index);
    }
}

/// Writes the rests of positions, which are a column of their own if radii differ.
GRAINSWEEP_LANES void write_rests(const Field& f, const Place* place, const F (&xyz)[4]) {
    F blocks_of[4];
    to_blocks(xyz, xyz[3], blocks_of);
    float rows[4][width];
    for (int k = 0; k < 4; ++k) store(rows[k], blocks_of[k]);
    for (int q = 0; q < width; ++q)
        store4(f.residuals[place[q] / places_per_index].position, load4(rows[q & 3] + (q & ~3)));
}

/// Steps the bodies of a batch. Forces are summed in single precision, as those on spheres are.
template <bool unequal>
GRAINSWEEP_PHASE void step_batch(const Field& f, const ClumpView& c, const ClumpBatch& b, LaneExtremes& extremes) {
    const D time = broadcast(c.time);
    D numbers[4];
    load_bodies<4>(c.orientation, b, numbers);
    LaneQuaternion q{numbers[0], numbers[1], numbers[2], numbers[3]};
    const LaneAxes before = axes_of(q);
    // With r = sum_k p_k e_k, sum r x F = sum_k e_k x (sum p_k F).
    V3 force = zero_vector(), torque = zero_vector(), moment[3] = {zero_vector(), zero_vector(), zero_vector()};
    for (std::int64_t slot = b.slot, k = 0; k < b.members; ++k, slot += width) {
        F rows[8];
        load_eights([&](int lane) { return load8(force_at(f.forces, c.place[slot + lane])->force); }, rows);
        const V3 on{rows[0], rows[1], rows[2]}, at = load(c.single_at, b.row + k * width);
        force = force + on;
        torque = torque + V3{rows[4], rows[5], rows[6]};
        moment[0] = fma(on, at.x, moment[0]), moment[1] = fma(on, at.y, moment[1]),
        moment[2] = fma(on, at.z, moment[2]);
    }
    for (int k = 0; k < 3; ++k) torque = add_cross(torque, single(before.of[k]), moment[k]);
    const D3 velocity =
        fma(fma(exact(force), load(c.inverse_mass + b.lane) * broadcast(c.force), broadcast(c.acceleration)), time,
            load_vectors(c.velocity, b));
    const D3 momentum = fma(exact(torque), broadcast(c.force * c.length * c.time), load_vectors(c.momentum, b));
    const D3 moved = velocity * time, position = load_vectors(c.position, b) + moved;
    const D3 spin = turn(q, before, momentum, load(c.inverse_inertia, b.lane), c.time);
    const D turned[4] = {q.w, q.x, q.y, q.z};
    store_bodies<4>(c.orientation, b, turned);
    store_vectors(c.velocity, b, velocity);
    store_vectors(c.momentum, b, momentum);
    store_vectors(c.position, b, position);
    store_vectors(c.spin_in_step, b, spin);
    D fallen;
    load_bodies<1>(c.fallen, b, &fallen);
    fallen = fma(load(c.mass + b.lane), dot(broadcast(c.gravity), moved), fallen);
    store_bodies<1>(c.fallen, b, &fallen);

    // A member at p is at the centre + sum_k p_k e_k, and moves with the velocity + sum_k p_k (w x e_k).
    const LaneAxes now = axes_of(q);
    const D3 per_unit = broadcast(c.inverse_unit), from_centre = position - broadcast(c.centre);
    const D3 centre{from_centre.x * per_unit.x, from_centre.y * per_unit.y, from_centre.z * per_unit.z};
    const V3 single_spin = single(spin * time), single_velocity = single(velocity * broadcast(c.inverse_speed));
    LaneAxes in_units_along;
    V3 axes[3], speed_along[3];
    for (int k = 0; k < 3; ++k) {
        const D3 e = now.of[k];
        in_units_along.of[k] = {e.x * per_unit.x, e.y * per_unit.y, e.z * per_unit.z};
        axes[k] = single(e);
        speed_along[k] = cross(single_spin, axes[k]);
    }
    // The way of a member during the step differs by less than w^2 r from its velocity at the end.
    const F slack = dot(single_spin, single_spin) * load(c.reach + b.lane), zero = broadcast(0.0f);
    extremes.include(3, single_spin, zero);
    const F inverse_mass = load(c.inverse_mass_single + b.lane);
    for (std::int64_t slot = b.slot, k = 0; k < b.members; ++k, slot += width) {
        const std::int64_t row = b.row + k * width;
        const D3 at = load(c.at, row);
        const D3 x =
            fma(in_units_along.of[0], at.x, fma(in_units_along.of[1], at.y, fma(in_units_along.of[2], at.z, centre)));
        const V3 p = load(c.single_at, row);
        const V3 v = fma(speed_along[0], p.x, fma(speed_along[1], p.y, fma(speed_along[2], p.z, single_velocity)));
        extremes.include(0, v, slack);
        const InUnits ux = in_units(x.x), uy = in_units(x.y), uz = in_units(x.z);
        const F radius = load(c.radius + row);
        const F place[4] = {ux.whole, uy.whole, uz.whole, load(c.inverse_radius + row)};
        const F motion[4] = {v.x, v.y, v.z, inverse_mass};
        const F rotation[4] = {single_spin.x, single_spin.y, single_spin.z, radius};
        const F rests[4] = {ux.rest, uy.rest, uz.rest, zero};
        F8 low[width], high[width];
        to_eights(place, motion, low);
        if constexpr (unequal) {
            const V3 surface = single_spin * radius;
            const F turning[4] = {surface.x, surface.y, surface.z, radius};
            to_eights(rotation, turning, high);
            write_rests(f, c.place + slot, rests);
        } else {
            to_eights(rotation, rests, high);
        }
        for (int lane = 0; lane < width; ++lane) {
            const Place to = c.place[slot + lane];
            auto* const record = reinterpret_cast<float*>(f.records + to / places_per_index);
            store8(record, low[lane]);
            store8(record + 8, high[lane]);
            store8(force_at(f.forces, to)->force, broadcast8(0.0f));
        }
    }
    write_mobility(f, c, b, axes);
}

template <bool unequal>
void step_clumps(const Field& f, const ClumpView& c, std::int32_t begin, std::int32_t end, Tally& t) {
    const auto denormals = flush_denormals();
    LaneExtremes extremes(t);
    for (std::int32_t k = begin; k < end; ++k) {
        if (f.read_ahead != 0 && k + 1 < end) fetch(f, c, c.batches[k + 1]);
        step_batch<unequal>(f, c, c.batches[k], extremes);
    }
    extremes.add_to(t);
    restore_denormals(denormals);
}

inline void find_mobility(const Field& f, const ClumpView& c, std::int32_t begin, std::int32_t end) {
    const auto denormals = flush_denormals();
    for (std::int32_t k = begin; k < end; ++k) {
        D numbers[4];
        load_bodies<4>(c.orientation, c.batches[k], numbers);
        const LaneAxes now = axes_of({numbers[0], numbers[1], numbers[2], numbers[3]});
        const V3 axes[3] = {single(now.of[0]), single(now.of[1]), single(now.of[2])};
        write_mobility(f, c, c.batches[k], axes);
    }
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
