// Transposition between records of particles and lanes of pairs. Four components of four pairs are transposed within
// blocks of 128 bits; block b of a vector belongs to the pairs 4b to 4b+3. One file per path includes this file after
// its lanes; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/particle_lanes.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Returns a vector whose block b is of(4b + e).
template <class Of>
GRAINSWEEP_LANES auto blocks(const Of& of, int e) {
#if HWY_CAP_GE512
    return joined(joined(of(e), of(e + 4)), joined(of(e + 8), of(e + 12)));
#elif HWY_CAP_GE256
    return joined(of(e), of(e + 4));
#else
    return of(e);
#endif
}
GRAINSWEEP_LANES Vector<float, 4> block(const Record* r, Place k, int number) {
    return hn::Load(four, reinterpret_cast<const float*>(record_at(r, k)) + 4 * number);
}

using V = Vector<float, width>;
template <class Lanes>
GRAINSWEEP_LANES Lanes low_pairs(Lanes a, Lanes b) {
    const Tag<hwy::MakeWide<hn::TFromV<Lanes>>, width / 2> pairs;
    return hn::BitCast(hn::DFromV<Lanes>{}, hn::InterleaveLower(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
}
template <class Lanes>
GRAINSWEEP_LANES Lanes high_pairs(Lanes a, Lanes b) {
    const Tag<hwy::MakeWide<hn::TFromV<Lanes>>, width / 2> pairs;
    return hn::BitCast(hn::DFromV<Lanes>{}, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
}
/// Transposes blocks. Integers use integer instructions, because some processors need an extra cycle between the two
/// kinds.
template <class Lanes, class Row>
GRAINSWEEP_LANES void transpose_blocks(const Lanes* z, Row* out) {
    const hn::DFromV<Lanes> d;
    const Lanes t0 = hn::InterleaveLower(d, z[0], z[1]), t1 = hn::InterleaveLower(d, z[2], z[3]);
    const Lanes t2 = hn::InterleaveUpper(d, z[0], z[1]), t3 = hn::InterleaveUpper(d, z[2], z[3]);
    out[0].v = low_pairs(t0, t1);
    out[1].v = high_pairs(t0, t1);
    out[2].v = low_pairs(t2, t3);
    out[3].v = high_pairs(t2, t3);
}
#if HWY_CAP_GE256
/// Return blocks 0 and 2, or 1 and 3, of a and then of b.
GRAINSWEEP_LANES V even_blocks(V a, V b) {
#if HWY_CAP_GE512
    return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
#else
    return hn::ConcatLowerLower(singles, b, a);
#endif
}
GRAINSWEEP_LANES V odd_blocks(V a, V b) {
#if HWY_CAP_GE512
    return hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
#else
    return hn::ConcatUpperUpper(singles, b, a);
#endif
}
#endif

/// Loads rows 0-2 of four integers each; of(q) is the source of lane q.
template <class Of>
GRAINSWEEP_LANES void load_integers(const Of& of, I& x, I& y, I& z) {
    Vector<std::int32_t, width> a[4];
    for (int e = 0; e < 4; ++e) a[e] = blocks(of, e);
    I out[4];
    transpose_blocks(a, out);
    x = out[0];
    y = out[1];
    z = out[2];
}
GRAINSWEEP_LANES Vector<std::int32_t, 4> position_at(const Record* r, Place k) {
    return hn::Load(Tag<std::int32_t, 4>{}, record_at(r, k)->position);
}
GRAINSWEEP_LANES void load_positions(const Record* r, const Place* particle, I& x, I& y, I& z) {
    load_integers([&](int q) { return position_at(r, particle[q]); }, x, y, z);
}
/// Loads the parts of positions that are below a unit, in units, and what single precision drops of the radii. Fillers
/// have finite ones.
GRAINSWEEP_LANES void load_below_units(const Field& f, const Place* particle, F* rows) {
    const bool apart = f.residuals != nullptr;
    const float* const first = apart ? f.residuals->position : f.records->rest;
    const std::uint64_t stride = (apart ? sizeof(Residual) : sizeof(Record)) / sizeof(float) / places_per_index;
    V a[4];
    for (int e = 0; e < 4; ++e) a[e] = blocks([&](int q) { return hn::Load(four, first + particle[q] * stride); }, e);
    transpose_blocks(a, rows);
    if (!apart) rows[3] = broadcast(0.0f);
}
/// Loads position of first minus position of second.
GRAINSWEEP_LANES void load_offsets(const Record* r, const Place* first, const Place* second, I& x, I& y, I& z) {
    load_integers([&](int q) { return hn::Sub(position_at(r, first[q]), position_at(r, second[q])); }, x, y, z);
}

/// Loads rows 0-7 of eight numbers each; of(q) is the source of lane q.
template <class Of>
GRAINSWEEP_LANES void load_eights(const Of& of, F* rows) {
#if HWY_CAP_GE256
    V z[8];
    F half[2][4];
    for (int e = 0; e < 8; ++e) {
#if HWY_CAP_GE512
        z[e] = joined(of(e).v, of(8 + e).v);
#else
        z[e] = of(e).v;
#endif
    }
    transpose_blocks(z, half[0]);
    transpose_blocks(z + 4, half[1]);
    for (int c = 0; c < 4; ++c) {
        rows[c].v = even_blocks(half[0][c].v, half[1][c].v);
        rows[4 + c].v = odd_blocks(half[0][c].v, half[1][c].v);
    }
#else
    V low[4], high[4];
    for (int e = 0; e < 4; ++e) {
        const F8 eight = of(e);
        low[e] = eight.lo.v;
        high[e] = eight.hi.v;
    }
    transpose_blocks(low, rows);
    transpose_blocks(high, rows + 4);
#endif
}
/// Loads rows 0-3: velocities and inverse masses; rows 4-7: spins and radii.
GRAINSWEEP_LANES void load_motion(const Record* r, const Place* particle, F* rows) {
    load_eights([&](int q) { return load8(record_at(r, particle[q])->velocity); }, rows);
}
/// Loads rows 0-3: velocity differences and sum of inverse masses; rows 4-7: sums of spins and of radii.
GRAINSWEEP_LANES void load_motion(const Record* r, const Place* first, const Place* second, F* rows) {
    alignas(32) static constexpr float signs[8] = {-1, -1, -1, 1, 1, 1, 1, 1};
    const auto pair = [&](int q) {
        const float *one = record_at(r, first[q])->velocity, *other = record_at(r, second[q])->velocity;
#if HWY_CAP_GE256
        return fma(load8(other), load8(signs), load8(one));
#else
        return F8{fma(load4(other), load4(signs), load4(one)), load4(one + 4) + load4(other + 4)};
#endif
    };
    load_eights(pair, rows);
}
GRAINSWEEP_LANES F load_radii(const Record* r, const Place* particle) {
    V a[4];
    for (int e = 0; e < 4; ++e) a[e] = blocks([&](int q) { return block(r, particle[q], 2); }, e);
    F rows[4];
    transpose_blocks(a, rows);
    return rows[3];
}

/// Loads rows 0-2: sums of radius times spin; row 3: difference of radii.
GRAINSWEEP_LANES void load_surface(const Record* r, const Place* first, const Place* second, F* rows) {
    alignas(16) static constexpr float signs[4] = {1, 1, 1, -1};
    const auto sign = load4(signs).v;
    V a[4];
    for (int e = 0; e < 4; ++e)
        a[e] = blocks([&](int q) { return hn::MulAdd(block(r, second[q], 3), sign, block(r, first[q], 3)); }, e);
    transpose_blocks(a, rows);
}

/// Loads rows 0-2: differences of spins; row 3: difference of radii.
GRAINSWEEP_LANES void load_spin_difference(const Record* r, const Place* first, const Place* second, F* rows) {
    V a[4];
    for (int e = 0; e < 4; ++e) {
#if HWY_CAP_GE512
        const auto spins = [&](const Place* k) {
            const auto at = [&](int n) { return block(r, k[e + n], 2).raw; };
            __m512 v = _mm512_broadcast_f32x4(at(0));
            v = _mm512_mask_broadcast_f32x4(v, 0x00f0, at(4));
            v = _mm512_mask_broadcast_f32x4(v, 0x0f00, at(8));
            return V{_mm512_mask_broadcast_f32x4(v, 0xf000, at(12))};
        };
        a[e] = hn::Sub(spins(first), spins(second));
#else
        a[e] = blocks([&](int q) { return hn::Sub(block(r, first[q], 2), block(r, second[q], 2)); }, e);
#endif
    }
    transpose_blocks(a, rows);
}

/// Writes four-component vectors; block b of out[k] belongs to pair 4b+k.
GRAINSWEEP_LANES void to_blocks(const F* xyz, F fourth, F* out) {
    const V rows[4] = {xyz[0].v, xyz[1].v, xyz[2].v, fourth.v};
    const V a = hn::InterleaveLower(singles, rows[0], rows[1]), b = hn::InterleaveUpper(singles, rows[0], rows[1]);
    const V c = hn::InterleaveLower(singles, rows[2], rows[3]), d = hn::InterleaveUpper(singles, rows[2], rows[3]);
    out[0].v = low_pairs(a, c);
    out[1].v = high_pairs(a, c);
    out[2].v = low_pairs(b, d);
    out[3].v = high_pairs(b, d);
}

/// Writes two four-component vectors of each pair.
GRAINSWEEP_LANES void to_eights(const F* first, F fourth, const F* second, F eighth, F8* out) {
    F f[4], t[4];
    to_blocks(first, fourth, f);
    to_blocks(second, eighth, t);
    for (int k = 0; k < 4; ++k) {
#if HWY_CAP_GE512
        const V a = even_blocks(f[k].v, t[k].v), b = odd_blocks(f[k].v, t[k].v);
        out[k].v = hn::LowerHalf(eight, a);
        out[4 + k].v = hn::LowerHalf(eight, b);
        out[8 + k].v = hn::UpperHalf(eight, a);
        out[12 + k].v = hn::UpperHalf(eight, b);
#elif HWY_CAP_GE256
        out[k].v = even_blocks(f[k].v, t[k].v);
        out[4 + k].v = odd_blocks(f[k].v, t[k].v);
#else
        out[k] = {f[k], t[k]};
#endif
    }
}

GRAINSWEEP_LANES void to_eights(const F (&first)[4], const F (&second)[4], F8* out) {
    to_eights(first, first[3], second, second[3], out);
}
/// Writes force and torque of each pair.
GRAINSWEEP_LANES void to_forces(const F* force, const F* torque, F8* out) {
    to_eights(force, broadcast(0.0f), torque, broadcast(0.0f), out);
}

GRAINSWEEP_LANES void add_to(Force* f, F8 a) {
    store8(f->force, load8(f->force) + a);
}
/// Subtracts the force and adds the torque.
GRAINSWEEP_LANES void react_on(Force* f, F8 a) {
#if HWY_CAP_GE256
    alignas(32) static constexpr float signs[8] = {-1, -1, -1, 0, 1, 1, 1, 0};
    store8(f->force, fma(a, load8(signs), load8(f->force)));
#else
    store4(f->force, load4(f->force) - a.lo);
    store4(f->torque, load4(f->torque) + a.hi);
#endif
}

/// Adds force and torque to the first particle of each pair, and minus the force and the other torque to the second, in
/// order.
GRAINSWEEP_LANES void scatter_unequal(Force* forces, const Place* first, const Place* second, const F* force,
                                      const F* torque_first, const F* torque_second) {
    F8 w[width], u[width];
    to_forces(force, torque_first, w);
    to_forces(force, torque_second, u);
    for (int q = 0; q < width; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        react_on(force_at(forces, second[q]), u[q]);
    }
}
/// Does the same for equal torques.
GRAINSWEEP_LANES void scatter_pairs(Force* forces, const Place* first, const Place* second, const F* force,
                                    const F* torque) {
    F8 w[width];
    to_forces(force, torque, w);
    for (int q = 0; q < width; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        react_on(force_at(forces, second[q]), w[q]);
    }
}
/// Adds the force to the first, minus the force to the second particle of each pair; no torques.
GRAINSWEEP_LANES void scatter_forces(Force* forces, const Place* first, const Place* second, const F* force) {
    F f[4];
    to_blocks(force, broadcast(0.0f), f);
    float w[4][width];
    for (int k = 0; k < 4; ++k) store(w[k], f[k]);
    for (int q = 0; q < width; ++q) {
        const F4 of_pair = load4(w[q & 3] + (q & ~3));
        float* a = force_at(forces, first[q])->force;
        store4(a, load4(a) + of_pair);
        float* b = force_at(forces, second[q])->force;
        store4(b, load4(b) - of_pair);
    }
}
/// Adds force and torque to the particles.
GRAINSWEEP_LANES void scatter(Force* forces, const Place* particle, const F* force, const F* torque) {
    F8 w[width];
    to_forces(force, torque, w);
    for (int q = 0; q < width; ++q) add_to(force_at(forces, particle[q]), w[q]);
}

/// Makes denormal numbers count as zero. Returns the previous mode.
GRAINSWEEP_LANES std::uint64_t flush_denormals() {
#if HWY_ARCH_X86
    const unsigned old = _mm_getcsr();
    _mm_setcsr(old | 0x8040u);
#else
    std::uint64_t old = 0;
    asm volatile("mrs %0, fpcr" : "=r"(old));
    asm volatile("msr fpcr, %0" : : "r"(old | (std::uint64_t{1} << 24)));
#endif
    return old;
}
GRAINSWEEP_LANES void restore_denormals(std::uint64_t old) {
#if HWY_ARCH_X86
    _mm_setcsr(static_cast<unsigned>(old));
#else
    asm volatile("msr fpcr, %0" : : "r"(old));
#endif
}

}  // namespace
}  // namespace grainsweep::dem::fast
