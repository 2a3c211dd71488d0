// Motion of one particle, velocity and spin, in eight lanes, and four of its numbers in four lanes. One file per path
// includes this file after its lanes; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/lanes.hpp"

namespace grainsweep::dem::fast {
namespace {

using F4 = Singles<4>;
using I4 = Integers<4>;
constexpr Tag<float, 4> four;

GRAINSWEEP_LANES F4 load4(const float* p) {
    return {hn::LoadU(four, p)};
}
GRAINSWEEP_LANES I4 load4(const std::int32_t* p) {
    return {hn::LoadU(Tag<std::int32_t, 4>{}, p)};
}
GRAINSWEEP_LANES void store4(float* p, F4 a) {
    hn::StoreU(a.v, four, p);
}
GRAINSWEEP_LANES void store4(std::int32_t* p, I4 a) {
    hn::StoreU(a.v, Tag<std::int32_t, 4>{}, p);
}
GRAINSWEEP_LANES F4 broadcast4(float a) {
    return {hn::Set(four, a)};
}
GRAINSWEEP_LANES I4 rounded(F4 a) {
#if HWY_ARCH_X86  // NearestInt takes four instructions more, for numbers beyond 2^31
    return {Vector<std::int32_t, 4>{_mm_cvtps_epi32(a.v.raw)}};
#else
    return {hn::NearestInt(a.v)};
#endif
}

/// Returns a with its fourth lane replaced by a lane of b.
template <int lane>
GRAINSWEEP_LANES F4 with_fourth(F4 a, F4 b) {
#if HWY_ARCH_X86
    return {Vector<float, 4>{_mm_insert_ps(a.v.raw, b.v.raw, (lane << 6) | 0x30)}};
#else
    return {hn::InsertLane(a.v, 3, hn::ExtractLane(b.v, lane))};
#endif
}
/// Returns the fourth lanes of a, b and c, and 0.
GRAINSWEEP_LANES F4 fourths(F4 a, F4 b, F4 c) {
    const auto last = hn::ShiftRightLanes<2>(four, hn::InterleaveUpper(four, b.v, c.v));
    return {hn::CombineShiftRightBytes<12>(four, last, a.v)};
}

#if HWY_CAP_GE256
using F8 = Singles<8>;
constexpr Tag<float, 8> eight;

GRAINSWEEP_LANES F8 broadcast8(float a) {
    return {hn::Set(eight, a)};
}
GRAINSWEEP_LANES F8 join(F4 a, F4 b) {
    return {joined(a.v, b.v)};
}
GRAINSWEEP_LANES F4 low(F8 a) {
    return {hn::LowerHalf(four, a.v)};
}
GRAINSWEEP_LANES F4 high(F8 a) {
    return {hn::UpperHalf(four, a.v)};
}
GRAINSWEEP_LANES F8 load8(const float* p) {
    return {hn::LoadU(eight, p)};
}
GRAINSWEEP_LANES void store8(float* p, F8 a) {
    hn::StoreU(a.v, eight, p);
}
/// b where a > 0, else 0
GRAINSWEEP_LANES F8 where_positive(F8 a, F8 b) {
    return {hn::IfThenElseZero(hn::Gt(a.v, hn::Zero(eight)), b.v)};
}
/// Returns the fourth lane of a, the fourth and the eighth of b, and zeros.
GRAINSWEEP_LANES F8 fourths(F4 a, F8 b) {
#if HWY_CAP_GE512
    const __m256i lanes = _mm256_setr_epi32(11, 3, 7, 0, 0, 0, 0, 0);
    return {Vector<float, 8>{_mm256_maskz_permutex2var_ps(0x07, b.v.raw, lanes, _mm256_castps128_ps256(a.v.raw))}};
#elif HWY_ARCH_X86
    const __m128 of_b =
        _mm256_castps256_ps128(_mm256_permutevar8x32_ps(b.v.raw, _mm256_setr_epi32(0, 3, 7, 0, 0, 0, 0, 0)));
    return {Vector<float, 8>{_mm256_zextps128_ps256(_mm_insert_ps(of_b, a.v.raw, 0xc8))}};
#else
    return join(fourths(a, low(b), high(b)), broadcast4(0.0f));
#endif
}
/// Returns a and b with their fourth lanes replaced by the second and the third lane of c.
GRAINSWEEP_LANES F8 with_fourths(F4 a, F4 b, F4 c) {
#if HWY_CAP_GE512
    const __m256i lanes = _mm256_setr_epi32(0, 0, 0, 1, 0, 0, 0, 2);
    const F8 both = join(a, b);
    return {Vector<float, 8>{_mm256_mask_permutexvar_ps(both.v.raw, 0x88, lanes, _mm256_castps128_ps256(c.v.raw))}};
#else
    return join(with_fourth<1>(a, c), with_fourth<2>(b, c));
#endif
}
#else
struct F8 {
    F lo, hi;
};

GRAINSWEEP_LANES F8 broadcast8(float a) {
    return {broadcast(a), broadcast(a)};
}
GRAINSWEEP_LANES F8 join(F4 a, F4 b) {
    return {a, b};
}
GRAINSWEEP_LANES F4 low(F8 a) {
    return a.lo;
}
GRAINSWEEP_LANES F4 high(F8 a) {
    return a.hi;
}
GRAINSWEEP_LANES F8 load8(const float* p) {
    return {load(p), load(p + 4)};
}
GRAINSWEEP_LANES void store8(float* p, F8 a) {
    store(p, a.lo);
    store(p + 4, a.hi);
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
    return {fma(a.lo, b.lo, c.lo), fma(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES F8 min(F8 a, F8 b) {
    return {min(a.lo, b.lo), min(a.hi, b.hi)};
}
GRAINSWEEP_LANES F8 max(F8 a, F8 b) {
    return {max(a.lo, b.lo), max(a.hi, b.hi)};
}
/// b where a > 0, else 0
GRAINSWEEP_LANES F8 where_positive(F8 a, F8 b) {
    const F zero = broadcast(0.0f);
    return {keep(zero < a.lo, b.lo), keep(zero < a.hi, b.hi)};
}
GRAINSWEEP_LANES F8 fourths(F4 a, F8 b) {
    return {fourths(a, b.lo, b.hi), broadcast(0.0f)};
}
GRAINSWEEP_LANES F8 with_fourths(F4 a, F4 b, F4 c) {
    return {with_fourth<1>(a, c), with_fourth<2>(b, c)};
}
#endif

}  // namespace
}  // namespace grainsweep::dem::fast
