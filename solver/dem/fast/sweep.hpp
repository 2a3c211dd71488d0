// One pass over the particles: sift, meet, scatter, advance.
//
//   sift      listed pairs in list order: position differences, in single precision, decide which may touch; these
//             and their histories are packed together. A pair that does not touch costs this and nothing more.
//   meet      packed pairs in tiles: motion is loaded and transposed, the law evaluated, forces scattered; three
//             loops, so that the processor overlaps the vectors of one kind of work.
//   advance   a particle whose pairs are all behind is integrated at once, while it is in the nearest cache:
//             leapfrog v(t+dt/2) = v(t-dt/2) + dt f/m, x(t+dt) = x(t) + dt v(t+dt/2), the velocity Verlet whose
//             contact law sees half-step velocities. What rounding drops is carried to the next step.
//
// R^2 - r^2 is formed in double precision from exact differences: overlap = (R^2 - r^2)/(R + r) keeps its digits
// however stiff the particles are. Included by the files of the instruction paths; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Pairs that may touch, packed; the buffers of one tile and a remainder.
struct alignas(64) Packed {
    std::int32_t first[tile + 2 * width];
    std::int32_t second[tile + 2 * width];
    std::int32_t offset[3][tile + 2 * width];
    float motion[tile / width + 1][12][width];
    float outcome[tile / width + 1][9][width];
};

/// Where the packed pairs begin in the streams of histories.
struct Streams {
    std::int64_t read;
    std::int64_t write;
    std::int64_t met;
};

template <class Law>
GRAINSWEEP_LANES int sift(const Field& f, std::int32_t batch, Packed& p, int packed, Streams& s) {
    const std::int64_t k = static_cast<std::int64_t>(batch) * width;
    const std::int32_t* first = f.inner_first + k;
    const std::int32_t* second = f.inner_second + k;
    const Constants& c = f.constants;
    for (int q = 0; q < width; ++q) prefetch(f.records + second[q + tile]);
    I ix, iy, iz;
    load_offsets(f.records, first, second, ix, iy, iz);
    const F x = single(ix) * broadcast(c.unit_single[0]), y = single(iy) * broadcast(c.unit_single[1]),
            z = single(iz) * broadcast(c.unit_single[2]);
    F reach = broadcast(c.candidate_squared);
    if constexpr (Law::unequal) reach = load(f.inner_reach + k);
    const unsigned now = bits(fma(x, x, fma(y, y, z * z)) < reach);
    store(p.first + packed, compress(load(first), now));
    store(p.second + packed, compress(load(second), now));
    store(p.offset[0] + packed, compress(ix, now));
    store(p.offset[1] + packed, compress(iy, now));
    store(p.offset[2] + packed, compress(iz, now));
    const int count = __builtin_popcount(now);
    if constexpr (Law::friction) {
        const unsigned before = f.touching[batch];
        for (int a = 0; a < 3; ++a)
            store(f.history_next[a] + s.write, compress(expand(load(f.history[a] + s.read), before), now));
        f.touching_next[batch] = static_cast<std::uint16_t>(now);
        s.read += __builtin_popcount(before);
        s.write += count;
    }
    return packed + count;
}

/// Loads and transposes the motion of the packed pairs.
template <class Law>
GRAINSWEEP_LANES void gather(const Field& f, Packed& p, int batches) {
    for (int b = 0; b < batches; ++b) {
        const std::int32_t* first = p.first + b * width;
        const std::int32_t* second = p.second + b * width;
        for (int q = 0; q < width; ++q) prefetch(f.forces + second[q]);
        F rows[12];
        load_motion(f.records, first, second, rows);
        if constexpr (Law::unequal) load_surface(f.records, first, second, rows + 8);
        for (int r = 0; r < (Law::unequal ? 12 : 7); ++r) store(p.motion[b][r], rows[r]);
    }
}

/// R^2 - r^2 from exact differences, rounded once.
GRAINSWEEP_LANES F closeness(const Constants& c, I x, I y, I z, D reach_squared) {
    const D dx = exact(x) * broadcast(c.unit[0]), dy = exact(y) * broadcast(c.unit[1]),
            dz = exact(z) * broadcast(c.unit[2]);
    return single(fnma(dx, dx, fnma(dy, dy, fnma(dz, dz, reach_squared))));
}

/// Force and torques of the packed pairs, into the outcome rows; histories from stream index `at` on.
template <class Law>
GRAINSWEEP_LANES void meet(const Field& f, Packed& p, int batches, std::int64_t at, F& largest_overlap) {
    const Constants& c = f.constants;
    const F history_step = broadcast(f.history_step), half = broadcast(0.5f);
    for (int b = 0; b < batches; ++b) {
        const auto row = [&](int r) { return load(p.motion[b][r]); };
        const I ix = load(p.offset[0] + b * width), iy = load(p.offset[1] + b * width),
                iz = load(p.offset[2] + b * width);
        F reach, difference;
        D reach_squared;
        if constexpr (Law::unequal) {
            reach = row(7);
            difference = row(11);
            const D r = exact(reach);
            reach_squared = r * r;
        } else {
            reach = broadcast(2 * c.radius);
            difference = broadcast(0.0f);
            reach_squared = broadcast(c.reach_squared);
        }
        const F near = closeness(c, ix, iy, iz, reach_squared);
        const F square = max(single(reach_squared) - near, broadcast(1e-12f));
        Meeting m;
        m.touching = broadcast(0.0f) < near;
        const F inverse_distance = inverse_root(square);
        m.overlap = near * inverse(fma(square, inverse_distance, reach));
        m.normal = {single(ix) * (inverse_distance * broadcast(c.unit_single[0])),
                    single(iy) * (inverse_distance * broadcast(c.unit_single[1])),
                    single(iz) * (inverse_distance * broadcast(c.unit_single[2]))};
        m.velocity = {row(0), row(1), row(2)};
        const F shortening = half * m.overlap;
        F arm_first, arm_second;
        const V3 spin{row(4), row(5), row(6)};
        if constexpr (Law::unequal) {
            m.surface = {fnma(shortening, spin.x, row(8)), fnma(shortening, spin.y, row(9)),
                         fnma(shortening, spin.z, row(10))};
            arm_first = fms(half, reach + difference, shortening);
            arm_second = fms(half, reach - difference, shortening);
            const F product = (reach - difference) * (reach + difference);  // 4 R_i R_j
            m.root_radius = half * product * inverse_root(product * reach);
            m.damping = broadcast(c.damping) * inverse_root(row(3));
            largest_overlap = max(keep(m.touching, m.overlap * inverse(reach - abs(difference))), largest_overlap);
        } else {
            arm_first = broadcast(c.radius) - shortening;
            arm_second = arm_first;
            m.surface = spin * arm_first;
            m.root_radius = broadcast(c.root_radius);
            if constexpr (Law::frozen)
                m.damping = select(broadcast(1.5f * c.inverse_mass) < row(3), broadcast(c.damping_pair),
                                   broadcast(c.damping_frozen));
            else
                m.damping = broadcast(c.damping_pair);
            largest_overlap = max(keep(m.touching, m.overlap), largest_overlap);  // the diameter is 1
        }
        if constexpr (Law::cohesive)
            m.neck = pair_neck<Law>(c, near, inverse_distance, m.overlap, difference, m.root_radius);
        V3 history{}, force, turn;
        if constexpr (Law::friction)
            history = {load(f.history_next[0] + at + b * width), load(f.history_next[1] + at + b * width),
                       load(f.history_next[2] + at + b * width)};
        respond<Law>(c, m, history_step, history, force, turn);
        store(p.outcome[b][0], force.x);
        store(p.outcome[b][1], force.y);
        store(p.outcome[b][2], force.z);
        if constexpr (Law::friction) {
            store(f.history_next[0] + at + b * width, history.x);
            store(f.history_next[1] + at + b * width, history.y);
            store(f.history_next[2] + at + b * width, history.z);
            store(p.outcome[b][3], turn.x * arm_first);
            store(p.outcome[b][4], turn.y * arm_first);
            store(p.outcome[b][5], turn.z * arm_first);
            if constexpr (Law::unequal) {
                store(p.outcome[b][6], turn.x * arm_second);
                store(p.outcome[b][7], turn.y * arm_second);
                store(p.outcome[b][8], turn.z * arm_second);
            }
        }
    }
}

template <class Law>
GRAINSWEEP_LANES void scatter(const Field& f, const Packed& p, int batches) {
    for (int b = 0; b < batches; ++b) {
        F o[9];
        for (int r = 0; r < (Law::friction ? (Law::unequal ? 9 : 6) : 3); ++r) o[r] = load(p.outcome[b][r]);
        const std::int32_t* first = p.first + b * width;
        const std::int32_t* second = p.second + b * width;
        if constexpr (!Law::friction) {
            scatter_forces(f.forces, first, second, o);
        } else if constexpr (Law::unequal) {
            scatter_unequal(f.forces, first, second, o, o + 3, o + 6);
        } else {
            scatter_pairs(f.forces, first, second, o, o + 3);
        }
    }
}

/// What integrating needs at hand.
struct Stepper {
    F8 turning;  ///< factor of force and torque besides 1/m
    F8 gravity;
    F8 high, low;  ///< extremes of velocity and spin met
    F4 inverse_unit;
};

GRAINSWEEP_LANES Stepper stepper(const Constants& c, const Tally& t) {
    return {join(broadcast4(1.0f), broadcast4(c.rotation)), load8(c.gravity), load8(t.velocity_high),
            load8(t.velocity_low), load4(c.inverse_unit)};
}

template <class Law>
GRAINSWEEP_LANES void advance_one(const Field& f, std::int32_t i, Stepper& s) {
    Record& r = f.records[i];
    const F8 inverse_mass = broadcast8(r.inverse_mass);
    F8 change = load8(f.forces[i].force) * s.turning;
    store8(f.forces[i].force, broadcast8(0.0f));
    if constexpr (Law::unequal) {
        const F4 inverse_radius = broadcast4(r.inverse_radius);
        change = change * join(broadcast4(1.0f), inverse_radius * inverse_radius);
    }
    F8 gravity = s.gravity;
    if constexpr (Law::frozen) gravity = where_positive(inverse_mass, gravity);
    const F8 residue = load8(f.residuals[i].position);
    change = fma(change, inverse_mass, gravity) + join(high(residue), broadcast4(0.0f));
    const F8 old = load8(r.velocity);
    const F8 now = old + change;
    const F8 lost = change - (now - old);
    s.high = max(now, s.high);
    s.low = min(now, s.low);
    const F4 travel = fma(low(now), s.inverse_unit, low(residue));
    const I4 units = rounded(travel);
    const I4 position = load4(r.position) + units;
    store8(f.residuals[i].position, join(travel - single(units), low(lost)));
    store4(r.position, position);
    store8(r.velocity, now);
    if constexpr (Law::unequal) {
        const float radius = r.radius_again;
        store4(r.surface, high(now) * broadcast4(radius));
        r.radius_again = radius;
    }
}

template <class Law>
void advance(const Field& f, Tally& t) {
    const unsigned denormals = flush_denormals();
    Stepper s = stepper(f.constants, t);
    for (std::int32_t i = 0; i < f.count; ++i) advance_one<Law>(f, i, s);
    store8(t.velocity_high, s.high);
    store8(t.velocity_low, s.low);
    restore_denormals(denormals);
}

template <class Law>
void sweep(const Field& f, bool advancing, Tally& t) {
    const unsigned denormals = flush_denormals();
    Packed p;
    Streams streams{};
    Stepper s = stepper(f.constants, t);
    F largest_overlap = broadcast(t.overlap);
    const std::int32_t batches = f.inner_count / width;
    std::int32_t done = 0;
    int packed = 0;
    for (std::int32_t b = 0; b <= batches; ++b) {
        const bool last = b == batches;
        if (!last) packed = sift<Law>(f, b, p, packed, streams);
        if (packed < tile && !last) continue;
        t.contacts += last ? packed : packed / width * width;
        if (last)  // fill the vector up with a pair that never touches
            for (int q = packed; q < packed + width; ++q) {
                p.first[q] = f.count;
                p.second[q] = f.count + 1;
                p.offset[0][q] = p.offset[1][q] = p.offset[2][q] = INT32_MIN;
            }
        const int full = last ? (packed + width - 1) / width : packed / width;
        gather<Law>(f, p, full);
        meet<Law>(f, p, full, streams.met, largest_overlap);
        scatter<Law>(f, p, full);
        streams.met += full * width;
        packed = last ? 0 : packed - full * width;
        store(p.first, load(p.first + full * width));
        store(p.second, load(p.second + full * width));
        for (auto& offset : p.offset) store(offset, load(offset + full * width));
        if (!advancing) continue;
        const std::int32_t until = last ? f.count : packed > 0 ? p.first[0] : f.inner_first[(b + 1) * width];
        for (; done < until && done < f.count; ++done) advance_one<Law>(f, done, s);
    }
    t.overlap = largest(largest_overlap);
    store8(t.velocity_high, s.high);
    store8(t.velocity_low, s.low);
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
