// The motion of one particle, velocity and spin, as eight lanes, and four numbers of it as four. Included by one file
// per path only, after its lanes; internal linkage on purpose.
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
#endif

}  // namespace
}  // namespace grainsweep::dem::fast
