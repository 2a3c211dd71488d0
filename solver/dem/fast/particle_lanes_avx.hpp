// The eight motion components of one particle (velocity and spin, four each) in one AVX register, and the four of
// its position in half of one. Included by files compiled with AVX2 and FMA only; internal linkage on purpose.
#pragma once

#include <immintrin.h>

#include "solver/dem/fast/layout.hpp"

#define GRAINSWEEP_LANES inline __attribute__((always_inline))

namespace grainsweep::dem::fast {
namespace {

struct F8 {
    __m256 v;
};
struct F4 {
    __m128 v;
};
struct I4 {
    __m128i v;
};

GRAINSWEEP_LANES F8 load8(const float* p) {
    return {_mm256_loadu_ps(p)};
}
GRAINSWEEP_LANES void store8(float* p, F8 a) {
    _mm256_storeu_ps(p, a.v);
}
GRAINSWEEP_LANES F8 broadcast8(float a) {
    return {_mm256_set1_ps(a)};
}
GRAINSWEEP_LANES F8 operator+(F8 a, F8 b) {
    return {_mm256_add_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F8 operator-(F8 a, F8 b) {
    return {_mm256_sub_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F8 operator*(F8 a, F8 b) {
    return {_mm256_mul_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F8 fma(F8 a, F8 b, F8 c) {
    return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F8 min(F8 a, F8 b) {
    return {_mm256_min_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F8 max(F8 a, F8 b) {
    return {_mm256_max_ps(a.v, b.v)};
}
/// b where a > 0, else 0
GRAINSWEEP_LANES F8 where_positive(F8 a, F8 b) {
    return {_mm256_and_ps(_mm256_cmp_ps(a.v, _mm256_setzero_ps(), _CMP_GT_OQ), b.v)};
}
GRAINSWEEP_LANES F4 low(F8 a) {
    return {_mm256_castps256_ps128(a.v)};
}
GRAINSWEEP_LANES F4 high(F8 a) {
    return {_mm256_extractf128_ps(a.v, 1)};
}
GRAINSWEEP_LANES F8 join(F4 a, F4 b) {
    return {_mm256_set_m128(b.v, a.v)};
}

GRAINSWEEP_LANES F4 load4(const float* p) {
    return {_mm_loadu_ps(p)};
}
GRAINSWEEP_LANES void store4(float* p, F4 a) {
    _mm_storeu_ps(p, a.v);
}
GRAINSWEEP_LANES I4 load4(const std::int32_t* p) {
    return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))};
}
GRAINSWEEP_LANES void store4(std::int32_t* p, I4 a) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a.v);
}
GRAINSWEEP_LANES F4 operator-(F4 a, F4 b) {
    return {_mm_sub_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F4 operator*(F4 a, F4 b) {
    return {_mm_mul_ps(a.v, b.v)};
}
GRAINSWEEP_LANES F4 fma(F4 a, F4 b, F4 c) {
    return {_mm_fmadd_ps(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F4 broadcast4(float a) {
    return {_mm_set1_ps(a)};
}
GRAINSWEEP_LANES I4 operator+(I4 a, I4 b) {
    return {_mm_add_epi32(a.v, b.v)};
}
GRAINSWEEP_LANES I4 rounded(F4 a) {
    return {_mm_cvtps_epi32(a.v)};
}
GRAINSWEEP_LANES F4 single(I4 a) {
    return {_mm_cvtepi32_ps(a.v)};
}
/// Denormal numbers count as zero from here on; returns what restores the old rule.
GRAINSWEEP_LANES unsigned flush_denormals() {
    const unsigned old = _mm_getcsr();
    _mm_setcsr(old | 0x8040u);
    return old;
}
GRAINSWEEP_LANES void restore_denormals(unsigned old) {
    _mm_setcsr(old);
}

}  // namespace
}  // namespace grainsweep::dem::fast
