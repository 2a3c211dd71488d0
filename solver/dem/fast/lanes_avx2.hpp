// Eight lanes of AVX2 and FMA. Included by one file only; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/particle_lanes_avx.hpp"

namespace grainsweep::dem::fast {
namespace {

constexpr int width = 8;

struct F {
    __m256 v;
};
struct I {
    __m256i v;
};
struct D {
    __m256d lo, hi;
};
struct M {
    __m256 v;
};

GRAINSWEEP_LANES F broadcast(float a) {
    return {_mm256_set1_ps(a)};
}
GRAINSWEEP_LANES I broadcast(std::int32_t a) {
    return {_mm256_set1_epi32(a)};
}
GRAINSWEEP_LANES D broadcast(double a) {
    return {_mm256_set1_pd(a), _mm256_set1_pd(a)};
}
GRAINSWEEP_LANES F load(const float* p) {
    return {_mm256_loadu_ps(p)};
}
GRAINSWEEP_LANES I load(const std::int32_t* p) {
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
}
GRAINSWEEP_LANES I load(const std::uint32_t* p) {
    return load(reinterpret_cast<const std::int32_t*>(p));
}
GRAINSWEEP_LANES D load(const double* p) {
    return {_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
}
GRAINSWEEP_LANES void store(float* p, F a) {
    _mm256_storeu_ps(p, a.v);
}
GRAINSWEEP_LANES void store(std::int32_t* p, I a) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a.v);
}
GRAINSWEEP_LANES void store(std::uint32_t* p, I a) {
    store(reinterpret_cast<std::int32_t*>(p), a);
}

GRAINSWEEP_LANES F operator+(F a, F b) {
    return {_mm256_add_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator-(F a, F b) {
    return {_mm256_sub_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator*(F a, F b) {
    return {_mm256_mul_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F fma(F a, F b, F c) {
    return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fms(F a, F b, F c) {
    return {_mm256_fmsub_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fnma(F a, F b, F c) {
    return {_mm256_fnmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F min(F a, F b) {
    return {_mm256_min_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F max(F a, F b) {
    return {_mm256_max_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F abs(F a) {
    return {_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v)};
}
GRAINSWEEP_LANES I operator-(I a, I b) {
    return {_mm256_sub_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator+(I a, I b) {
    return {_mm256_add_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator&(I a, I b) {
    return {_mm256_and_si256(a.v, b.v)};
}

GRAINSWEEP_LANES F sqrt(F a) {
    return {_mm256_sqrt_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rsqrt(F a) {
    return {_mm256_rsqrt_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rcp(F a) {
    return {_mm256_rcp_ps(a.v)};
}

GRAINSWEEP_LANES F single(I a) {
    return {_mm256_cvtepi32_ps(a.v)};
}
GRAINSWEEP_LANES D exact(I a) {
    return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(a.v)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(a.v, 1))};
}
GRAINSWEEP_LANES D exact(F a) {
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(a.v)), _mm256_cvtps_pd(_mm256_extractf128_ps(a.v, 1))};
}
GRAINSWEEP_LANES F single(D a) {
    return {_mm256_set_m128(_mm256_cvtpd_ps(a.hi), _mm256_cvtpd_ps(a.lo))};
}
GRAINSWEEP_LANES D operator+(D a, D b) {
    return {_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator-(D a, D b) {
    return {_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator*(D a, D b) {
    return {_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator/(D a, D b) {
    return {_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D fma(D a, D b, D c) {
    return {_mm256_fmadd_pd(a.lo, b.lo, c.lo), _mm256_fmadd_pd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D fnma(D a, D b, D c) {
    return {_mm256_fnmadd_pd(a.lo, b.lo, c.lo), _mm256_fnmadd_pd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D min(D a, D b) {
    return {_mm256_min_pd(a.lo, b.lo), _mm256_min_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D max(D a, D b) {
    return {_mm256_max_pd(a.lo, b.lo), _mm256_max_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D sqrt(D a) {
    return {_mm256_sqrt_pd(a.lo), _mm256_sqrt_pd(a.hi)};
}
GRAINSWEEP_LANES D nearest_integer(D a) {
    return {_mm256_round_pd(a.lo, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC),
            _mm256_round_pd(a.hi, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
}
/// a < b ? c : d, lane by lane
GRAINSWEEP_LANES D where_less(D a, D b, D c, D d) {
    return {_mm256_blendv_pd(d.lo, c.lo, _mm256_cmp_pd(a.lo, b.lo, _CMP_LT_OQ)),
            _mm256_blendv_pd(d.hi, c.hi, _mm256_cmp_pd(a.hi, b.hi, _CMP_LT_OQ))};
}

GRAINSWEEP_LANES M operator<(F a, F b) {
    return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
GRAINSWEEP_LANES M operator&(M a, M b) {
    return {_mm256_and_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F keep(M m, F a) {
    return {_mm256_and_ps(m.v, a.v)};
}
GRAINSWEEP_LANES F drop(M m, F a) {
    return {_mm256_andnot_ps(m.v, a.v)};
}
GRAINSWEEP_LANES F select(M m, F a, F b) {
    return {_mm256_blendv_ps(b.v, a.v, m.v)};
}
GRAINSWEEP_LANES unsigned bits(M m) {
    return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}
GRAINSWEEP_LANES unsigned sign_bits(I a) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(a.v)));
}
GRAINSWEEP_LANES float largest(F a) {
    __m128 m = _mm_max_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    m = _mm_max_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}

/// Where lanes go: for each of the 256 masks eight 4-bit lane numbers, packed into a word.
struct LaneTables {
    std::uint32_t front[256];   ///< set lanes first
    std::uint32_t spread[256];  ///< the inverse
};
constexpr LaneTables make_lane_tables() {
    LaneTables t{};
    for (unsigned m = 0; m < 256; ++m) {
        unsigned front = 0;
        for (unsigned lane = 0; lane < 8; ++lane)
            if (((m >> lane) & 1) != 0) {
                t.front[m] |= lane << (4 * front);
                t.spread[m] |= front << (4 * lane);
                ++front;
            }
    }
    return t;
}
constexpr LaneTables lane_tables = make_lane_tables();

GRAINSWEEP_LANES __m256i unpack_lanes(std::uint32_t word) {
    const __m256i shifts = _mm256_set_epi32(28, 24, 20, 16, 12, 8, 4, 0);
    return _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(word)), shifts);  // permutes read the low three bits
}
GRAINSWEEP_LANES __m256i lanes_in(unsigned m) {
    const __m256i lane = _mm256_set_epi32(128, 64, 32, 16, 8, 4, 2, 1);
    return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(m)), lane), lane);
}
/// Lanes whose bit is set, moved together to the front; rubbish behind them.
GRAINSWEEP_LANES F compress(F a, unsigned m) {
    return {_mm256_permutevar8x32_ps(a.v, unpack_lanes(lane_tables.front[m]))};
}
GRAINSWEEP_LANES I compress(I a, unsigned m) {
    return {_mm256_permutevar8x32_epi32(a.v, unpack_lanes(lane_tables.front[m]))};
}
/// The inverse: leading lanes moved to the lanes whose bit is set, zero elsewhere.
GRAINSWEEP_LANES F expand(F a, unsigned m) {
    const __m256 moved = _mm256_permutevar8x32_ps(a.v, unpack_lanes(lane_tables.spread[m]));
    return {_mm256_and_ps(moved, _mm256_castsi256_ps(lanes_in(m)))};
}
/// Sets the sign of lanes whose bit is set.
GRAINSWEEP_LANES I with_sign_bits(I a, unsigned m) {
    return {_mm256_or_si256(a.v, _mm256_slli_epi32(lanes_in(m), 31))};
}
GRAINSWEEP_LANES I lane_numbers() {
    return {_mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0)};
}

GRAINSWEEP_LANES const Record* record_at(const Record* r, Place p) {
    return reinterpret_cast<const Record*>(reinterpret_cast<const char*>(r) + std::uint64_t{p} * (sizeof(Record) / 8));
}
GRAINSWEEP_LANES Force* force_at(Force* f, Place p) {
    return reinterpret_cast<Force*>(reinterpret_cast<char*>(f) + std::uint64_t{p} * (sizeof(Force) / 8));
}

GRAINSWEEP_LANES void prefetch(const void* p) {
    _mm_prefetch(static_cast<const char*>(p), _MM_HINT_T0);
}

/// The same 16-byte block of records k[0] and k[4].
template <int Block>
GRAINSWEEP_LANES __m256 two_blocks(const Record* r, const Place* k) {
    const auto at = [&](int n) { return _mm_load_ps(reinterpret_cast<const float*>(record_at(r, k[n])) + 4 * Block); };
    return _mm256_insertf128_ps(_mm256_castps128_ps256(at(0)), at(4), 1);
}

/// Position of first minus position of second, for eight pairs.
GRAINSWEEP_LANES void load_offsets(const Record* r, const Place* first, const Place* second, I& x, I& y, I& z) {
    __m256i a[4];
    for (int e = 0; e < 4; ++e)
        a[e] = _mm256_sub_epi32(_mm256_castps_si256(two_blocks<0>(r, first + e)),
                                _mm256_castps_si256(two_blocks<0>(r, second + e)));
    const __m256i t0 = _mm256_unpacklo_epi32(a[0], a[1]), t1 = _mm256_unpacklo_epi32(a[2], a[3]);
    const __m256i t2 = _mm256_unpackhi_epi32(a[0], a[1]), t3 = _mm256_unpackhi_epi32(a[2], a[3]);
    x.v = _mm256_unpacklo_epi64(t0, t1);
    y.v = _mm256_unpackhi_epi64(t0, t1);
    z.v = _mm256_unpacklo_epi64(t2, t3);
}

GRAINSWEEP_LANES __m256 low_pairs(__m256 a, __m256 b) {
    return _mm256_castpd_ps(_mm256_unpacklo_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
}
GRAINSWEEP_LANES __m256 high_pairs(__m256 a, __m256 b) {
    return _mm256_castpd_ps(_mm256_unpackhi_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
}
GRAINSWEEP_LANES void transpose_blocks(const __m256* z, __m256* out) {
    const __m256 t0 = _mm256_unpacklo_ps(z[0], z[1]), t1 = _mm256_unpacklo_ps(z[2], z[3]);
    const __m256 t2 = _mm256_unpackhi_ps(z[0], z[1]), t3 = _mm256_unpackhi_ps(z[2], z[3]);
    out[0] = low_pairs(t0, t1);
    out[1] = high_pairs(t0, t1);
    out[2] = low_pairs(t2, t3);
    out[3] = high_pairs(t2, t3);
}

/// Rows 0-3: velocity differences and sum of inverse masses; rows 4-7: sums of spins and of radii.
GRAINSWEEP_LANES void load_motion(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m256 sign = _mm256_set_ps(1, 1, 1, 1, 1, -1, -1, -1);
    __m256 z[8], half[2][4];
    for (int q = 0; q < 8; ++q)
        z[q] = _mm256_fmadd_ps(_mm256_loadu_ps(record_at(r, second[q])->velocity), sign,
                               _mm256_loadu_ps(record_at(r, first[q])->velocity));
    transpose_blocks(z, half[0]);
    transpose_blocks(z + 4, half[1]);
    for (int c = 0; c < 4; ++c) {
        rows[c].v = _mm256_permute2f128_ps(half[0][c], half[1][c], 0x20);
        rows[4 + c].v = _mm256_permute2f128_ps(half[0][c], half[1][c], 0x31);
    }
}

/// Rows 0-2: sums of radius times spin; row 3: difference of radii.
GRAINSWEEP_LANES void load_surface(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m256 sign = _mm256_set_ps(-1, 1, 1, 1, -1, 1, 1, 1);
    __m256 a[4], out[4];
    for (int e = 0; e < 4; ++e) a[e] = _mm256_fmadd_ps(two_blocks<3>(r, second + e), sign, two_blocks<3>(r, first + e));
    transpose_blocks(a, out);
    for (int c = 0; c < 4; ++c) rows[c].v = out[c];
}

/// Rows 0-2: differences of spins; row 3: difference of radii.
GRAINSWEEP_LANES void load_spin_difference(const Record* r, const Place* first, const Place* second, F* rows) {
    __m256 a[4], out[4];
    for (int e = 0; e < 4; ++e) a[e] = _mm256_sub_ps(two_blocks<2>(r, first + e), two_blocks<2>(r, second + e));
    transpose_blocks(a, out);
    for (int c = 0; c < 4; ++c) rows[c].v = out[c];
}

/// Four-component vectors of eight pairs, block b of out[k] belonging to pair 4b+k.
GRAINSWEEP_LANES void to_blocks(F x, F y, F z, __m256* out) {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 a = _mm256_unpacklo_ps(x.v, y.v), b = _mm256_unpackhi_ps(x.v, y.v);
    const __m256 c = _mm256_unpacklo_ps(z.v, zero), d = _mm256_unpackhi_ps(z.v, zero);
    out[0] = low_pairs(a, c);
    out[1] = high_pairs(a, c);
    out[2] = low_pairs(b, d);
    out[3] = high_pairs(b, d);
}

/// Force and torque of eight pairs as vectors of eight.
GRAINSWEEP_LANES void to_forces(const F* force, const F* torque, __m256* out) {
    __m256 f[4], t[4];
    to_blocks(force[0], force[1], force[2], f);
    to_blocks(torque[0], torque[1], torque[2], t);
    for (int k = 0; k < 4; ++k) {
        out[k] = _mm256_permute2f128_ps(f[k], t[k], 0x20);
        out[4 + k] = _mm256_permute2f128_ps(f[k], t[k], 0x31);
    }
}

GRAINSWEEP_LANES void add_to(Force* f, __m256 a) {
    float* p = f->force;
    _mm256_store_ps(p, _mm256_add_ps(_mm256_load_ps(p), a));
}

/// Adds force and torque to the first, minus force and torque to the second particle of each pair, in order.
GRAINSWEEP_LANES void scatter_pairs(Force* forces, const Place* first, const Place* second, const F* force,
                                    const F* torque) {
    __m256 w[8];
    to_forces(force, torque, w);
    const __m256 sign = _mm256_set_ps(0, 1, 1, 1, 0, -1, -1, -1);
    for (int q = 0; q < 8; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        float* p = force_at(forces, second[q])->force;
        _mm256_store_ps(p, _mm256_fmadd_ps(w[q], sign, _mm256_load_ps(p)));
    }
}
/// The same where the torques on the two differ.
GRAINSWEEP_LANES void scatter_unequal(Force* forces, const Place* first, const Place* second, const F* force,
                                      const F* torque_first, const F* torque_second) {
    __m256 w[8], u[8];
    to_forces(force, torque_first, w);
    to_forces(force, torque_second, u);
    const __m256 sign = _mm256_set_ps(0, 1, 1, 1, 0, -1, -1, -1);
    for (int q = 0; q < 8; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        float* p = force_at(forces, second[q])->force;
        _mm256_store_ps(p, _mm256_fmadd_ps(u[q], sign, _mm256_load_ps(p)));
    }
}
/// Adds the force to the first, minus the force to the second particle of each pair; no torques.
GRAINSWEEP_LANES void scatter_forces(Force* forces, const Place* first, const Place* second, const F* force) {
    __m256 f[4];
    to_blocks(force[0], force[1], force[2], f);
    for (int q = 0; q < 8; ++q) {
        const __m128 w = q < 4 ? _mm256_castps256_ps128(f[q & 3]) : _mm256_extractf128_ps(f[q & 3], 1);
        float* a = force_at(forces, first[q])->force;
        _mm_store_ps(a, _mm_add_ps(_mm_load_ps(a), w));
        float* b = force_at(forces, second[q])->force;
        _mm_store_ps(b, _mm_sub_ps(_mm_load_ps(b), w));
    }
}
/// Adds force and torque to the particles.
GRAINSWEEP_LANES void scatter(Force* forces, const Place* particle, const F* force, const F* torque) {
    __m256 w[8];
    to_forces(force, torque, w);
    for (int q = 0; q < 8; ++q) add_to(force_at(forces, particle[q]), w[q]);
}

}  // namespace
}  // namespace grainsweep::dem::fast
