// Sixteen lanes of AVX-512 (F, DQ, VL, BW). Included by one file only; internal linkage on purpose.
#pragma once

#include <immintrin.h>

#include "solver/dem/fast/particle_lanes_avx.hpp"

namespace grainsweep::dem::fast {
namespace {

constexpr int width = 16;

struct F {
    __m512 v;
};
struct I {
    __m512i v;
};
struct D {
    __m512d lo, hi;
};
struct M {
    __mmask16 v;
};

GRAINSWEEP_LANES F broadcast(float a) {
    return {_mm512_set1_ps(a)};
}
GRAINSWEEP_LANES I broadcast(std::int32_t a) {
    return {_mm512_set1_epi32(a)};
}
GRAINSWEEP_LANES D broadcast(double a) {
    return {_mm512_set1_pd(a), _mm512_set1_pd(a)};
}
GRAINSWEEP_LANES F load(const float* p) {
    return {_mm512_loadu_ps(p)};
}
GRAINSWEEP_LANES I load(const std::int32_t* p) {
    return {_mm512_loadu_si512(p)};
}
GRAINSWEEP_LANES I load(const std::uint32_t* p) {
    return load(reinterpret_cast<const std::int32_t*>(p));
}
GRAINSWEEP_LANES D load(const double* p) {
    return {_mm512_loadu_pd(p), _mm512_loadu_pd(p + 8)};
}
GRAINSWEEP_LANES void store(float* p, F a) {
    _mm512_storeu_ps(p, a.v);
}
GRAINSWEEP_LANES void store(std::int32_t* p, I a) {
    _mm512_storeu_si512(p, a.v);
}
GRAINSWEEP_LANES void store(std::uint32_t* p, I a) {
    store(reinterpret_cast<std::int32_t*>(p), a);
}

GRAINSWEEP_LANES F operator+(F a, F b) {
    return {_mm512_add_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator-(F a, F b) {
    return {_mm512_sub_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F operator*(F a, F b) {
    return {_mm512_mul_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F fma(F a, F b, F c) {
    return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fms(F a, F b, F c) {
    return {_mm512_fmsub_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fnma(F a, F b, F c) {
    return {_mm512_fnmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F min(F a, F b) {
    return {_mm512_min_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F max(F a, F b) {
    return {_mm512_max_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F abs(F a) {
    return {_mm512_abs_ps(a.v)};
}
GRAINSWEEP_LANES I operator-(I a, I b) {
    return {_mm512_sub_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator+(I a, I b) {
    return {_mm512_add_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I operator&(I a, I b) {
    return {_mm512_and_si512(a.v, b.v)};
}

GRAINSWEEP_LANES F sqrt(F a) {
    return {_mm512_sqrt_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rsqrt(F a) {
    return {_mm512_rsqrt14_ps(a.v)};
}
GRAINSWEEP_LANES F approximate_rcp(F a) {
    return {_mm512_rcp14_ps(a.v)};
}

GRAINSWEEP_LANES F single(I a) {
    return {_mm512_cvtepi32_ps(a.v)};
}
GRAINSWEEP_LANES D exact(I a) {
    return {_mm512_cvtepi32_pd(_mm512_castsi512_si256(a.v)), _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(a.v, 1))};
}
GRAINSWEEP_LANES D exact(F a) {
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(a.v)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(a.v, 1))};
}
GRAINSWEEP_LANES F single(D a) {
    return {_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(a.lo)), _mm512_cvtpd_ps(a.hi), 1)};
}
GRAINSWEEP_LANES D operator+(D a, D b) {
    return {_mm512_add_pd(a.lo, b.lo), _mm512_add_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator-(D a, D b) {
    return {_mm512_sub_pd(a.lo, b.lo), _mm512_sub_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator*(D a, D b) {
    return {_mm512_mul_pd(a.lo, b.lo), _mm512_mul_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator/(D a, D b) {
    return {_mm512_div_pd(a.lo, b.lo), _mm512_div_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D fma(D a, D b, D c) {
    return {_mm512_fmadd_pd(a.lo, b.lo, c.lo), _mm512_fmadd_pd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D fnma(D a, D b, D c) {
    return {_mm512_fnmadd_pd(a.lo, b.lo, c.lo), _mm512_fnmadd_pd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D min(D a, D b) {
    return {_mm512_min_pd(a.lo, b.lo), _mm512_min_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D max(D a, D b) {
    return {_mm512_max_pd(a.lo, b.lo), _mm512_max_pd(a.hi, b.hi)};
}
GRAINSWEEP_LANES D sqrt(D a) {
    return {_mm512_sqrt_pd(a.lo), _mm512_sqrt_pd(a.hi)};
}
GRAINSWEEP_LANES D nearest_integer(D a) {
    return {_mm512_roundscale_pd(a.lo, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC),
            _mm512_roundscale_pd(a.hi, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
}
/// a < b ? c : d, lane by lane
GRAINSWEEP_LANES D where_less(D a, D b, D c, D d) {
    return {_mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.lo, b.lo, _CMP_LT_OQ), d.lo, c.lo),
            _mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.hi, b.hi, _CMP_LT_OQ), d.hi, c.hi)};
}

GRAINSWEEP_LANES M operator<(F a, F b) {
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
GRAINSWEEP_LANES M operator&(M a, M b) {
    return {static_cast<__mmask16>(a.v & b.v)};
}
GRAINSWEEP_LANES F keep(M m, F a) {
    return {_mm512_maskz_mov_ps(m.v, a.v)};
}
GRAINSWEEP_LANES F drop(M m, F a) {
    return {_mm512_maskz_mov_ps(static_cast<__mmask16>(~m.v), a.v)};
}
GRAINSWEEP_LANES F select(M m, F a, F b) {
    return {_mm512_mask_blend_ps(m.v, b.v, a.v)};
}
GRAINSWEEP_LANES unsigned bits(M m) {
    return m.v;
}
GRAINSWEEP_LANES unsigned sign_bits(I a) {
    return _mm512_movepi32_mask(a.v);
}
GRAINSWEEP_LANES float largest(F a) {
    return _mm512_reduce_max_ps(a.v);
}

/// Lanes whose bit is set, moved together to the front.
GRAINSWEEP_LANES F compress(F a, unsigned m) {
    return {_mm512_maskz_compress_ps(static_cast<__mmask16>(m), a.v)};
}
GRAINSWEEP_LANES I compress(I a, unsigned m) {
    return {_mm512_maskz_compress_epi32(static_cast<__mmask16>(m), a.v)};
}
/// The inverse: leading lanes moved to the lanes whose bit is set, zero elsewhere.
GRAINSWEEP_LANES F expand(F a, unsigned m) {
    return {_mm512_maskz_expand_ps(static_cast<__mmask16>(m), a.v)};
}
/// Sets the sign of lanes whose bit is set.
GRAINSWEEP_LANES I with_sign_bits(I a, unsigned m) {
    return {_mm512_mask_or_epi32(a.v, static_cast<__mmask16>(m), a.v, _mm512_set1_epi32(INT32_MIN))};
}
GRAINSWEEP_LANES I lane_numbers() {
    return {_mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0)};
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

/// The same 16-byte block of records k[0], k[4], k[8], k[12].
template <int Block>
GRAINSWEEP_LANES __m512 four_blocks(const Record* r, const Place* k) {
    const auto at = [&](int n) { return _mm_load_ps(reinterpret_cast<const float*>(record_at(r, k[n])) + 4 * Block); };
    __m512 a = _mm512_broadcast_f32x4(at(0));
    a = _mm512_mask_broadcast_f32x4(a, 0x00f0, at(4));
    a = _mm512_mask_broadcast_f32x4(a, 0x0f00, at(8));
    return _mm512_mask_broadcast_f32x4(a, 0xf000, at(12));
}

/// Position of first minus position of second, for sixteen pairs.
GRAINSWEEP_LANES void load_offsets(const Record* r, const Place* first, const Place* second, I& x, I& y, I& z) {
    const auto offset = [&](int q) {
        return _mm_sub_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(record_at(r, first[q])->position)),
                             _mm_load_si128(reinterpret_cast<const __m128i*>(record_at(r, second[q])->position)));
    };
    __m512i a[4];  // block b of a[e]: pair 4b+e
    for (int e = 0; e < 4; ++e) {
        const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(offset(e)), offset(e + 4), 1);
        const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(offset(e + 8)), offset(e + 12), 1);
        a[e] = _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
    }
    const __m512i t0 = _mm512_unpacklo_epi32(a[0], a[1]), t1 = _mm512_unpacklo_epi32(a[2], a[3]);
    const __m512i t2 = _mm512_unpackhi_epi32(a[0], a[1]), t3 = _mm512_unpackhi_epi32(a[2], a[3]);
    x.v = _mm512_unpacklo_epi64(t0, t1);
    y.v = _mm512_unpackhi_epi64(t0, t1);
    z.v = _mm512_unpacklo_epi64(t2, t3);
}

GRAINSWEEP_LANES __m512 low_pairs(__m512 a, __m512 b) {
    return _mm512_castpd_ps(_mm512_unpacklo_pd(_mm512_castps_pd(a), _mm512_castps_pd(b)));
}
GRAINSWEEP_LANES __m512 high_pairs(__m512 a, __m512 b) {
    return _mm512_castpd_ps(_mm512_unpackhi_pd(_mm512_castps_pd(a), _mm512_castps_pd(b)));
}

/// Rows 0-3: velocity differences and sum of inverse masses; rows 4-7: sums of spins and of radii.
GRAINSWEEP_LANES void load_motion(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m256 sign = _mm256_set_ps(1, 1, 1, 1, 1, -1, -1, -1);
    const auto pair = [&](int q) {
        const __m256 a = _mm256_loadu_ps(record_at(r, first[q])->velocity),
                     b = _mm256_loadu_ps(record_at(r, second[q])->velocity);
        return _mm256_fmadd_ps(b, sign, a);
    };
    __m512 half[2][8];
    for (int g = 0; g < 2; ++g) {
        __m512 z[4];
        for (int e = 0; e < 4; ++e)
            z[e] = _mm512_insertf32x8(_mm512_castps256_ps512(pair(8 * g + e)), pair(8 * g + 4 + e), 1);
        const __m512 t0 = _mm512_unpacklo_ps(z[0], z[1]), t1 = _mm512_unpacklo_ps(z[2], z[3]);
        const __m512 t2 = _mm512_unpackhi_ps(z[0], z[1]), t3 = _mm512_unpackhi_ps(z[2], z[3]);
        half[g][0] = low_pairs(t0, t1);
        half[g][1] = high_pairs(t0, t1);
        half[g][2] = low_pairs(t2, t3);
        half[g][3] = high_pairs(t2, t3);
    }
    for (int c = 0; c < 4; ++c) {
        rows[c].v = _mm512_shuffle_f32x4(half[0][c], half[1][c], 0x88);
        rows[4 + c].v = _mm512_shuffle_f32x4(half[0][c], half[1][c], 0xdd);
    }
}

/// Rows 0-2: sums of radius times spin; row 3: difference of radii.
GRAINSWEEP_LANES void load_surface(const Record* r, const Place* first, const Place* second, F* rows) {
    const __m512 sign = _mm512_broadcast_f32x4(_mm_set_ps(-1, 1, 1, 1));
    __m512 a[4];
    for (int e = 0; e < 4; ++e)
        a[e] = _mm512_fmadd_ps(four_blocks<3>(r, second + e), sign, four_blocks<3>(r, first + e));
    const __m512 t0 = _mm512_unpacklo_ps(a[0], a[1]), t1 = _mm512_unpacklo_ps(a[2], a[3]);
    const __m512 t2 = _mm512_unpackhi_ps(a[0], a[1]), t3 = _mm512_unpackhi_ps(a[2], a[3]);
    rows[0].v = low_pairs(t0, t1);
    rows[1].v = high_pairs(t0, t1);
    rows[2].v = low_pairs(t2, t3);
    rows[3].v = high_pairs(t2, t3);
}

/// Rows 0-2: differences of spins; row 3: difference of radii.
GRAINSWEEP_LANES void load_spin_difference(const Record* r, const Place* first, const Place* second, F* rows) {
    __m512 a[4];
    for (int e = 0; e < 4; ++e) a[e] = _mm512_sub_ps(four_blocks<2>(r, first + e), four_blocks<2>(r, second + e));
    const __m512 t0 = _mm512_unpacklo_ps(a[0], a[1]), t1 = _mm512_unpacklo_ps(a[2], a[3]);
    const __m512 t2 = _mm512_unpackhi_ps(a[0], a[1]), t3 = _mm512_unpackhi_ps(a[2], a[3]);
    rows[0].v = low_pairs(t0, t1);
    rows[1].v = high_pairs(t0, t1);
    rows[2].v = low_pairs(t2, t3);
    rows[3].v = high_pairs(t2, t3);
}

/// Four-component vectors of sixteen pairs, block b of out[k] belonging to pair 4b+k.
GRAINSWEEP_LANES void to_blocks(F x, F y, F z, __m512* out) {
    const __m512 zero = _mm512_setzero_ps();
    const __m512 a = _mm512_unpacklo_ps(x.v, y.v), b = _mm512_unpackhi_ps(x.v, y.v);
    const __m512 c = _mm512_unpacklo_ps(z.v, zero), d = _mm512_unpackhi_ps(z.v, zero);
    out[0] = low_pairs(a, c);
    out[1] = high_pairs(a, c);
    out[2] = low_pairs(b, d);
    out[3] = high_pairs(b, d);
}

/// Force and torque of sixteen pairs as vectors of eight.
GRAINSWEEP_LANES void to_forces(const F* force, const F* torque, __m256* out) {
    __m512 f[4], t[4];
    to_blocks(force[0], force[1], force[2], f);
    to_blocks(torque[0], torque[1], torque[2], t);
    const __m512i even = _mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0), odd = _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4);
    for (int k = 0; k < 4; ++k) {
        const __m512d fd = _mm512_castps_pd(f[k]), td = _mm512_castps_pd(t[k]);
        const __m512 a = _mm512_castpd_ps(_mm512_permutex2var_pd(fd, even, td));
        const __m512 b = _mm512_castpd_ps(_mm512_permutex2var_pd(fd, odd, td));
        out[k] = _mm512_castps512_ps256(a);
        out[4 + k] = _mm512_extractf32x8_ps(a, 1);
        out[8 + k] = _mm512_castps512_ps256(b);
        out[12 + k] = _mm512_extractf32x8_ps(b, 1);
    }
}

GRAINSWEEP_LANES void add_to(Force* f, __m256 a) {
    float* p = f->force;
    _mm256_store_ps(p, _mm256_add_ps(_mm256_load_ps(p), a));
}

/// Adds force and torque to the first, minus force and torque to the second particle of each pair, in order.
GRAINSWEEP_LANES void scatter_pairs(Force* forces, const Place* first, const Place* second, const F* force,
                                    const F* torque) {
    __m256 w[16];
    to_forces(force, torque, w);
    const __m256 sign = _mm256_set_ps(0, 1, 1, 1, 0, -1, -1, -1);
    for (int q = 0; q < 16; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        float* p = force_at(forces, second[q])->force;
        _mm256_store_ps(p, _mm256_fmadd_ps(w[q], sign, _mm256_load_ps(p)));
    }
}
/// The same where the torques on the two differ.
GRAINSWEEP_LANES void scatter_unequal(Force* forces, const Place* first, const Place* second, const F* force,
                                      const F* torque_first, const F* torque_second) {
    __m256 w[16], u[16];
    to_forces(force, torque_first, w);
    to_forces(force, torque_second, u);
    const __m256 sign = _mm256_set_ps(0, 1, 1, 1, 0, -1, -1, -1);
    for (int q = 0; q < 16; ++q) {
        add_to(force_at(forces, first[q]), w[q]);
        float* p = force_at(forces, second[q])->force;
        _mm256_store_ps(p, _mm256_fmadd_ps(u[q], sign, _mm256_load_ps(p)));
    }
}
/// Adds the force to the first, minus the force to the second particle of each pair; no torques.
GRAINSWEEP_LANES void scatter_forces(Force* forces, const Place* first, const Place* second, const F* force) {
    __m512 f[4];
    to_blocks(force[0], force[1], force[2], f);
    __m128 w[16];
    for (int k = 0; k < 4; ++k) {
        w[k] = _mm512_castps512_ps128(f[k]);
        w[4 + k] = _mm512_extractf32x4_ps(f[k], 1);
        w[8 + k] = _mm512_extractf32x4_ps(f[k], 2);
        w[12 + k] = _mm512_extractf32x4_ps(f[k], 3);
    }
    for (int q = 0; q < 16; ++q) {
        float* a = force_at(forces, first[q])->force;
        _mm_store_ps(a, _mm_add_ps(_mm_load_ps(a), w[q]));
        float* b = force_at(forces, second[q])->force;
        _mm_store_ps(b, _mm_sub_ps(_mm_load_ps(b), w[q]));
    }
}
/// Adds force and torque to the particles.
GRAINSWEEP_LANES void scatter(Force* forces, const Place* particle, const F* force, const F* torque) {
    __m256 w[16];
    to_forces(force, torque, w);
    for (int q = 0; q < 16; ++q) add_to(force_at(forces, particle[q]), w[q]);
}

}  // namespace
}  // namespace grainsweep::dem::fast
