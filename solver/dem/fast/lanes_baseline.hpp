// Four lanes of SSE4.2, which every x86-64-v2 processor has; no fused multiply-add: fma rounds twice here.
// Included by one file only; internal linkage on purpose.
#pragma once

#include <immintrin.h>

#include "solver/dem/fast/layout.hpp"

#define GRAINSWEEP_LANES inline __attribute__((always_inline))

namespace grainsweep::dem::fast {
namespace {

constexpr int width = 4;

struct F {
    __m128 v;
};
struct I {
    __m128i v;
};
struct D {
    __m128d lo, hi;
};
struct M {
    __m128 v;
};

GRAINSWEEP_LANES F broadcast(float a) {
    return {_mm_set1_ps(a)};
}
GRAINSWEEP_LANES I broadcast(std::int32_t a) {
    return {_mm_set1_epi32(a)};
}
GRAINSWEEP_LANES D broadcast(double a) {
    return {_mm_set1_pd(a), _mm_set1_pd(a)};
}
GRAINSWEEP_LANES F load(const float* p) {
    return {_mm_loadu_ps(p)};
}
GRAINSWEEP_LANES I load(const std::int32_t* p) {
    return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))};
}
GRAINSWEEP_LANES I load(const std::uint32_t* p) {
    return load(reinterpret_cast<const std::int32_t*>(p));
}
GRAINSWEEP_LANES D load(const double* p) {
    return {_mm_loadu_pd(p), _mm_loadu_pd(p + 2)};
}
GRAINSWEEP_LANES void store(float* p, F a) {
    _mm_storeu_ps(p, a.v);
}
GRAINSWEEP_LANES void store(std::int32_t* p, I a) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a.v);
}
GRAINSWEEP_LANES void store(std::uint32_t* p, I a) {
    store(reinterpret_cast<std::int32_t*>(p), a);
}

GRAINSWEEP_LANES F operator+(F a, F b) {
    return {_mm_add_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator-(F a, F b) {
    return {_mm_sub_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator*(F a, F b) {
    return {_mm_mul_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F fma(F a, F b, F c) {
    return a * b + c;
}
GRAINSWEEP_LANES F fms(F a, F b, F c) {
    return a * b - c;
}
GRAINSWEEP_LANES F fnma(F a, F b, F c) {
    return c - a * b;
}
GRAINSWEEP_LANES F min(F a, F b) {
    return {_mm_min_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F max(F a, F b) {
    return {_mm_max_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F abs(F a) {
    return {_mm_andnot_ps(_mm_set1_ps(-0.0F), a.v)};
}
GRAINSWEEP_LANES I operator-(I a, I b) {
    return {_mm_sub_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator+(I a, I b) {
    return {_mm_add_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator&(I a, I b) {
    return {_mm_and_si128(a.v, b.v)};
}

GRAINSWEEP_LANES F sqrt(F a) {
    return {_mm_sqrt_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rsqrt(F a) {
    return {_mm_rsqrt_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rcp(F a) {
    return {_mm_rcp_ps(a.v)};
}

GRAINSWEEP_LANES F single(I a) {
    return {_mm_cvtepi32_ps(a.v)};
}
GRAINSWEEP_LANES D exact(I a) {
    return {_mm_cvtepi32_pd(a.v), _mm_cvtepi32_pd(_mm_unpackhi_epi64(a.v, a.v))};
}
GRAINSWEEP_LANES D exact(F a) {
    return {_mm_cvtps_pd(a.v), _mm_cvtps_pd(_mm_movehl_ps(a.v, a.v))};
}
GRAINSWEEP_LANES F single(D a) {
    return {_mm_movelh_ps(_mm_cvtpd_ps(a.lo), _mm_cvtpd_ps(a.hi))};
}
GRAINSWEEP_LANES D operator+(D a, D b) {
    return {_mm_add_pd(a.lo, b.lo), _mm_add_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator-(D a, D b) {
    return {_mm_sub_pd(a.lo, b.lo), _mm_sub_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator*(D a, D b) {
    return {_mm_mul_pd(a.lo, b.lo), _mm_mul_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator/(D a, D b) {
    return {_mm_div_pd(a.lo, b.lo), _mm_div_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D fma(D a, D b, D c) {
    return a * b + c;
}
GRAINSWEEP_LANES D fnma(D a, D b, D c) {
    return c - a * b;
}
GRAINSWEEP_LANES D min(D a, D b) {
    return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D max(D a, D b) {
    return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D sqrt(D a) {
    return {_mm_sqrt_pd(a.lo), _mm_sqrt_pd(a.hi)};
}
GRAINSWEEP_LANES D nearest_integer(D a) {
    return {_mm_round_pd(a.lo, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC),
            _mm_round_pd(a.hi, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
}
/// a < b ? c : d, lane by lane
GRAINSWEEP_LANES D where_less(D a, D b, D c, D d) {
    return {_mm_blendv_pd(d.lo, c.lo, _mm_cmplt_pd(a.lo, b.lo)), _mm_blendv_pd(d.hi, c.hi, _mm_cmplt_pd(a.hi, b.hi))};
}

GRAINSWEEP_LANES M operator<(F a, F b) {
    return {_mm_cmplt_ps(a.v, b.v)};
}
GRAINSWEEP_LANES M operator&(M a, M b) {
    return {_mm_and_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F keep(M m, F a) {
    return {_mm_and_ps(m.v, a.v)};
}
GRAINSWEEP_LANES F drop(M m, F a) {
    return {_mm_andnot_ps(m.v, a.v)};
}
GRAINSWEEP_LANES F select(M m, F a, F b) {
    return {_mm_blendv_ps(b.v, a.v, m.v)};
}
GRAINSWEEP_LANES unsigned bits(M m) {
    return static_cast<unsigned>(_mm_movemask_ps(m.v));
}
GRAINSWEEP_LANES unsigned sign_bits(I a) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(a.v)));
}
GRAINSWEEP_LANES float largest(F a) {
    const __m128 m = _mm_max_ps(a.v, _mm_movehl_ps(a.v, a.v));
    return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}

/// Byte shuffles for each of the 16 masks; an index with its top bit set gives zero.
struct alignas(16) LaneTables {
    unsigned char front[16][16];   ///< set lanes first
    unsigned char spread[16][16];  ///< the inverse
};
constexpr LaneTables make_lane_tables() {
    LaneTables t{};
    for (unsigned m = 0; m < 16; ++m) {
        for (auto& b : t.front[m]) b = 0x80;
        for (auto& b : t.spread[m]) b = 0x80;
        unsigned front = 0;
        for (unsigned lane = 0; lane < 4; ++lane) {
            if (((m >> lane) & 1) == 0) continue;
            for (unsigned b = 0; b < 4; ++b) {
                t.front[m][4 * front + b] = static_cast<unsigned char>(4 * lane + b);
                t.spread[m][4 * lane + b] = static_cast<unsigned char>(4 * front + b);
            }
            ++front;
        }
    }
    return t;
}
constexpr LaneTables lane_tables = make_lane_tables();

GRAINSWEEP_LANES __m128i shuffled(__m128i a, const unsigned char* order) {
    return _mm_shuffle_epi8(a, _mm_load_si128(reinterpret_cast<const __m128i*>(order)));
}
/// Lanes whose bit is set, moved together to the front.
GRAINSWEEP_LANES I compress(I a, unsigned m) {
    return {shuffled(a.v, lane_tables.front[m])};
}
GRAINSWEEP_LANES F compress(F a, unsigned m) {
    return {_mm_castsi128_ps(shuffled(_mm_castps_si128(a.v), lane_tables.front[m]))};
}
/// The inverse: leading lanes moved to the lanes whose bit is set, zero elsewhere.
GRAINSWEEP_LANES F expand(F a, unsigned m) {
    return {_mm_castsi128_ps(shuffled(_mm_castps_si128(a.v), lane_tables.spread[m]))};
}
/// Sets the sign of lanes whose bit is set.
GRAINSWEEP_LANES I with_sign_bits(I a, unsigned m) {
    const __m128i lane = _mm_set_epi32(8, 4, 2, 1);
    const __m128i set = _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(m)), lane), lane);
    return {_mm_or_si128(a.v, _mm_slli_epi32(set, 31))};
}
GRAINSWEEP_LANES I lane_numbers() {
    return {_mm_set_epi32(3, 2, 1, 0)};
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

template <int Block>
GRAINSWEEP_LANES __m128 block(const Record* r, Place k) {
    return _mm_load_ps(reinterpret_cast<const float*>(record_at(r, k)) + 4 * Block);
}
GRAINSWEEP_LANES void transpose_blocks(const __m128* z, F* out) {
    const __m128 t0 = _mm_unpacklo_ps(z[0], z[1]), t1 = _mm_unpacklo_ps(z[2], z[3]);
    const __m128 t2 = _mm_unpackhi_ps(z[0], z[1]), t3 = _mm_unpackhi_ps(z[2], z[3]);
    out[0].v = _mm_movelh_ps(t0, t1);
    out[1].v = _mm_movehl_ps(t1, t0);
    out[2].v = _mm_movelh_ps(t2, t3);
    out[3].v = _mm_movehl_ps(t3, t2);
}

/// Position of first minus position of second, for four pairs.
GRAINSWEEP_LANES void load_offsets(const Record* r, const Place* first, const Place* second, I& x, I& y, I& z) {
    __m128i a[4];
    for (int e = 0; e < 4; ++e)
        a[e] = _mm_sub_epi32(_mm_castps_si128(block<0>(r, first[e])), _mm_castps_si128(block<0>(r, second[e])));
    const __m128i t0 = _mm_unpacklo_epi32(a[0], a[1]), t1 = _mm_unpacklo_epi32(a[2], a[3]);
    const __m128i t2 = _mm_unpackhi_epi32(a[0], a[1]), t3 = _mm_unpackhi_epi32(a[2], a[3]);
    x.v = _mm_unpacklo_epi64(t0, t1);
    y.v = _mm_unpackhi_epi64(t0, t1);
    z.v = _mm_unpacklo_epi64(t2, t3);
}

/// Rows 0-3: velocity differences and sum of inverse masses; rows 4-7: sums of spins and of radii.
GRAINSWEEP_LANES void load_motion(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m128 flip = _mm_castsi128_ps(_mm_set_epi32(0, INT32_MIN, INT32_MIN, INT32_MIN));
    __m128 v[4], w[4];
    for (int e = 0; e < 4; ++e) {
        v[e] = _mm_add_ps(block<1>(r, first[e]), _mm_xor_ps(block<1>(r, second[e]), flip));
        w[e] = _mm_add_ps(block<2>(r, first[e]), block<2>(r, second[e]));
    }
    transpose_blocks(v, rows);
    transpose_blocks(w, rows + 4);
}

/// Rows 0-2: sums of radius times spin; row 3: difference of radii.
GRAINSWEEP_LANES void load_surface(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m128 flip = _mm_castsi128_ps(_mm_set_epi32(INT32_MIN, 0, 0, 0));
    __m128 a[4];
    for (int e = 0; e < 4; ++e) a[e] = _mm_add_ps(block<3>(r, first[e]), _mm_xor_ps(block<3>(r, second[e]), flip));
    transpose_blocks(a, rows);
}

/// Rows 0-2: differences of spins; row 3: difference of radii.
GRAINSWEEP_LANES void load_spin_difference(const Record* r, const Place* first, const Place* second, F* rows) {
    __m128 a[4];
    for (int e = 0; e < 4; ++e) a[e] = _mm_sub_ps(block<2>(r, first[e]), block<2>(r, second[e]));
    transpose_blocks(a, rows);
}

GRAINSWEEP_LANES void to_blocks(F x, F y, F z, F* out) {
    const __m128 rows[4] = {x.v, y.v, z.v, _mm_setzero_ps()};
    transpose_blocks(rows, out);
}
GRAINSWEEP_LANES void add_to(float* p, F a) {
    _mm_store_ps(p, _mm_add_ps(_mm_load_ps(p), a.v));
}
GRAINSWEEP_LANES void subtract_from(float* p, F a) {
    _mm_store_ps(p, _mm_sub_ps(_mm_load_ps(p), a.v));
}

/// Adds force and torque to the first, minus force and torque to the second particle of each pair; the torques differ.
GRAINSWEEP_LANES void scatter_unequal(Force* forces, const Place* first, const Place* second, const F* force,
                                      const F* torque_first, const F* torque_second) {
    F f[4], t[4], u[4];
    to_blocks(force[0], force[1], force[2], f);
    to_blocks(torque_first[0], torque_first[1], torque_first[2], t);
    to_blocks(torque_second[0], torque_second[1], torque_second[2], u);
    for (int q = 0; q < 4; ++q) {
        add_to(force_at(forces, first[q])->force, f[q]);
        add_to(force_at(forces, first[q])->torque, t[q]);
        subtract_from(force_at(forces, second[q])->force, f[q]);
        add_to(force_at(forces, second[q])->torque, u[q]);
    }
}
/// The same where the torques are equal.
GRAINSWEEP_LANES void scatter_pairs(Force* forces, const Place* first, const Place* second, const F* force,
                                    const F* torque) {
    F f[4], t[4];
    to_blocks(force[0], force[1], force[2], f);
    to_blocks(torque[0], torque[1], torque[2], t);
    for (int q = 0; q < 4; ++q) {
        add_to(force_at(forces, first[q])->force, f[q]);
        add_to(force_at(forces, first[q])->torque, t[q]);
        subtract_from(force_at(forces, second[q])->force, f[q]);
        add_to(force_at(forces, second[q])->torque, t[q]);
    }
}
/// Forces only.
GRAINSWEEP_LANES void scatter_forces(Force* forces, const Place* first, const Place* second, const F* force) {
    F f[4];
    to_blocks(force[0], force[1], force[2], f);
    for (int q = 0; q < 4; ++q) {
        add_to(force_at(forces, first[q])->force, f[q]);
        subtract_from(force_at(forces, second[q])->force, f[q]);
    }
}
/// Adds force and torque to the particles.
GRAINSWEEP_LANES void scatter(Force* forces, const Place* particle, const F* force, const F* torque) {
    F f[4], t[4];
    to_blocks(force[0], force[1], force[2], f);
    to_blocks(torque[0], torque[1], torque[2], t);
    for (int q = 0; q < 4; ++q) {
        add_to(force_at(forces, particle[q])->force, f[q]);
        add_to(force_at(forces, particle[q])->torque, t[q]);
    }
}

// ---- the motion of one particle

using F4 = F;
using I4 = I;
struct F8 {
    F lo, hi;
};

GRAINSWEEP_LANES F8 load8(const float* p) {
    return {load(p), load(p + 4)};
}
GRAINSWEEP_LANES void store8(float* p, F8 a) {
    store(p, a.lo);
    store(p + 4, a.hi);
}
GRAINSWEEP_LANES F8 broadcast8(float a) {
    return {broadcast(a), broadcast(a)};
}
GRAINSWEEP_LANES F8 operator+(F8 a, F8 b) {
    return {a.lo + b.lo, a.hi + b.hi};
}
GRAINSWEEP_LANES F8 operator-(F8 a, F8 b) {
    return {a.lo - b.lo, a.hi - b.hi};
}
GRAINSWEEP_LANES F8 operator*(F8 a, F8 b) {
    return {a.lo * b.lo, a.hi * b.hi};
}
GRAINSWEEP_LANES F8 fma(F8 a, F8 b, F8 c) {
    return a * b + c;
}
GRAINSWEEP_LANES F8 min(F8 a, F8 b) {
    return {min(a.lo, b.lo), min(a.hi, b.hi)};
}
GRAINSWEEP_LANES F8 max(F8 a, F8 b) {
    return {max(a.lo, b.lo), max(a.hi, b.hi)};
}
/// b where a > 0, else 0
GRAINSWEEP_LANES F8 where_positive(F8 a, F8 b) {
    const F zero = broadcast(0.0F);
    return {keep(zero < a.lo, b.lo), keep(zero < a.hi, b.hi)};
}
GRAINSWEEP_LANES F4 low(F8 a) {
    return a.lo;
}
GRAINSWEEP_LANES F4 high(F8 a) {
    return a.hi;
}
GRAINSWEEP_LANES F8 join(F4 a, F4 b) {
    return {a, b};
}
GRAINSWEEP_LANES F4 load4(const float* p) {
    return load(p);
}
GRAINSWEEP_LANES I4 load4(const std::int32_t* p) {
    return load(p);
}
GRAINSWEEP_LANES void store4(float* p, F4 a) {
    store(p, a);
}
GRAINSWEEP_LANES void store4(std::int32_t* p, I4 a) {
    store(p, a);
}
GRAINSWEEP_LANES F4 broadcast4(float a) {
    return broadcast(a);
}
GRAINSWEEP_LANES I4 rounded(F4 a) {
    return {_mm_cvtps_epi32(a.v)};
}
/// Denormal numbers count as zero from here on; returns what restores the old rule.
GRAINSWEEP_LANES unsigned flush_denormals() {
    const unsigned old = _mm_getcsr();
    _mm_setcsr(old | 0x8040U);
    return old;
}
GRAINSWEEP_LANES void restore_denormals(unsigned old) {
    _mm_setcsr(old);
}

}  // namespace
}  // namespace grainsweep::dem::fast
