// Vectors of as many single-precision numbers as the instructions of a path hold: sixteen with AVX-512, eight with
// AVX2, four with SSE4 and NEON. They use Highway for the target of the file. Highway's functions are internal to each
// file, so paths share no code. One file per path includes this file; it has internal linkage on purpose.
#pragma once

#define HWY_DISABLE_PCLMUL_AES  // x86-64-v2 to v4 do not promise them
#if defined(__aarch64__)
#define TOOLCHAIN_MISS_SYS_AUXV_H  // else it asks for the crypto extension
#endif
#define HWY_IS_DEBUG_BUILD 0  // its checks refuse table indices with bits that the instructions ignore
#include <hwy/highway.h>

#include "solver/dem/fast/layout.hpp"

#define GRAINSWEEP_LANES inline __attribute__((always_inline))

namespace grainsweep::dem::fast {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int width = HWY_MAX_BYTES / 4;

template <class Number, int N>
using Tag = hn::FixedTag<Number, N>;
template <class Number, int N>
using Vector = hn::Vec<Tag<Number, N>>;

template <int N>
struct Singles {
    Vector<float, N> v;
};
template <int N>
struct Integers {
    Vector<std::int32_t, N> v;
};
using F = Singles<width>;
using I = Integers<width>;
struct D {
    Vector<double, width / 2> lo, hi;
};
struct M {
    hn::Mask<Tag<float, width>> v;
};
constexpr Tag<float, width> singles;
constexpr Tag<std::int32_t, width> integers;
constexpr Tag<double, width / 2> doubles;
constexpr Tag<float, width / 2> half_singles;
constexpr Tag<std::int32_t, width / 2> half_integers;

// Joins two halves. Highway's Combine would clear the upper half first.
#if HWY_CAP_GE256
GRAINSWEEP_LANES Vector<float, 8> joined(Vector<float, 4> low, Vector<float, 4> high) {
    return Vector<float, 8>{_mm256_insertf128_ps(_mm256_castps128_ps256(low.raw), high.raw, 1)};
}
GRAINSWEEP_LANES Vector<std::int32_t, 8> joined(Vector<std::int32_t, 4> low, Vector<std::int32_t, 4> high) {
    return Vector<std::int32_t, 8>{_mm256_inserti128_si256(_mm256_castsi128_si256(low.raw), high.raw, 1)};
}
#endif
#if HWY_CAP_GE512
GRAINSWEEP_LANES Vector<float, 16> joined(Vector<float, 8> low, Vector<float, 8> high) {
    return Vector<float, 16>{_mm512_insertf32x8(_mm512_castps256_ps512(low.raw), high.raw, 1)};
}
GRAINSWEEP_LANES Vector<std::int32_t, 16> joined(Vector<std::int32_t, 8> low, Vector<std::int32_t, 8> high) {
    return Vector<std::int32_t, 16>{_mm512_inserti64x4(_mm512_castsi256_si512(low.raw), high.raw, 1)};
}
#endif
#if !HWY_CAP_GE256
GRAINSWEEP_LANES Vector<float, 4> joined(Vector<float, 2> low, Vector<float, 2> high) {
    return hn::Combine(singles, high, low);
}
#endif

GRAINSWEEP_LANES F broadcast(float a) {
    return {hn::Set(singles, a)};
}
GRAINSWEEP_LANES I broadcast(std::int32_t a) {
    return {hn::Set(integers, a)};
}
GRAINSWEEP_LANES D broadcast(double a) {
    return {hn::Set(doubles, a), hn::Set(doubles, a)};
}
GRAINSWEEP_LANES F load(const float* p) {
    return {hn::LoadU(singles, p)};
}
GRAINSWEEP_LANES I load(const std::int32_t* p) {
    return {hn::LoadU(integers, p)};
}
GRAINSWEEP_LANES I load(const std::uint32_t* p) {
    return load(reinterpret_cast<const std::int32_t*>(p));
}
GRAINSWEEP_LANES D load(const double* p) {
    return {hn::LoadU(doubles, p), hn::LoadU(doubles, p + width / 2)};
}
GRAINSWEEP_LANES void store(float* p, F a) {
    hn::StoreU(a.v, singles, p);
}
GRAINSWEEP_LANES void store(std::int32_t* p, I a) {
    hn::StoreU(a.v, integers, p);
}
GRAINSWEEP_LANES void store(std::uint32_t* p, I a) {
    store(reinterpret_cast<std::int32_t*>(p), a);
}

template <int N>
GRAINSWEEP_LANES Singles<N> operator+(Singles<N> a, Singles<N> b) {
    return {hn::Add(a.v, b.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> operator-(Singles<N> a, Singles<N> b) {
    return {hn::Sub(a.v, b.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> operator*(Singles<N> a, Singles<N> b) {
    return {hn::Mul(a.v, b.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> fma(Singles<N> a, Singles<N> b,
                                Singles<N> c) {  // rounded twice if there is no such instruction
    return {hn::MulAdd(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fms(F a, F b, F c) {
    return {hn::MulSub(a.v, b.v, c.v)};
}
GRAINSWEEP_LANES F fnma(F a, F b, F c) {
    return {hn::NegMulAdd(a.v, b.v, c.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> min(Singles<N> a, Singles<N> b) {
    return {hn::Min(a.v, b.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> max(Singles<N> a, Singles<N> b) {
    return {hn::Max(a.v, b.v)};
}
GRAINSWEEP_LANES F operator/(F a, F b) {
    return {hn::Div(a.v, b.v)};
}
GRAINSWEEP_LANES F abs(F a) {
    return {hn::Abs(a.v)};
}
GRAINSWEEP_LANES F sqrt(F a) {
    return {hn::Sqrt(a.v)};
}
/// Returns a^(-1/3) within 4 %, for a > 0: the bits of a number, as an integer, are nearly its logarithm.
GRAINSWEEP_LANES F start_of_inverse_cbrt(F a) {
    const auto bits = hn::ConvertTo(singles, hn::BitCast(integers, a.v));
    const auto third = hn::ConvertTo(integers, hn::Mul(bits, hn::Set(singles, 1.0F / 3)));
    return {hn::BitCast(singles, hn::Sub(hn::Set(integers, 1419967116), third))};
}
#if HWY_ARCH_X86
GRAINSWEEP_LANES F approximate_rsqrt(F a) {
    return {hn::ApproximateReciprocalSqrt(a.v)};
}
GRAINSWEEP_LANES F approximate_rcp(F a) {
    return {hn::ApproximateReciprocal(a.v)};
}
#else  // estimates of other processors have fewer than the eleven digits that one Newton step takes to the end
GRAINSWEEP_LANES F approximate_rsqrt(F a) {
    return {hn::Div(hn::Set(singles, 1.0f), hn::Sqrt(a.v))};
}
GRAINSWEEP_LANES F approximate_rcp(F a) {
    return {hn::Div(hn::Set(singles, 1.0f), a.v)};
}
#endif
template <int N>
GRAINSWEEP_LANES Integers<N> operator+(Integers<N> a, Integers<N> b) {
    return {hn::Add(a.v, b.v)};
}
GRAINSWEEP_LANES I operator-(I a, I b) {
    return {hn::Sub(a.v, b.v)};
}
GRAINSWEEP_LANES I operator&(I a, I b) {
    return {hn::And(a.v, b.v)};
}
template <int N>
GRAINSWEEP_LANES Singles<N> single(Integers<N> a) {
    return {hn::ConvertTo(Tag<float, N>{}, a.v)};
}

GRAINSWEEP_LANES D exact(I a) {
    return {hn::PromoteTo(doubles, hn::LowerHalf(half_integers, a.v)),
            hn::PromoteTo(doubles, hn::UpperHalf(half_integers, a.v))};
}
GRAINSWEEP_LANES D exact(F a) {
    return {hn::PromoteTo(doubles, hn::LowerHalf(half_singles, a.v)),
            hn::PromoteTo(doubles, hn::UpperHalf(half_singles, a.v))};
}
GRAINSWEEP_LANES F single(D a) {
    return {joined(hn::DemoteTo(half_singles, a.lo), hn::DemoteTo(half_singles, a.hi))};
}
GRAINSWEEP_LANES D operator+(D a, D b) {
    return {hn::Add(a.lo, b.lo), hn::Add(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator-(D a, D b) {
    return {hn::Sub(a.lo, b.lo), hn::Sub(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator*(D a, D b) {
    return {hn::Mul(a.lo, b.lo), hn::Mul(a.hi, b.hi)};
}
GRAINSWEEP_LANES D operator/(D a, D b) {
    return {hn::Div(a.lo, b.lo), hn::Div(a.hi, b.hi)};
}
GRAINSWEEP_LANES D fma(D a, D b, D c) {
    return {hn::MulAdd(a.lo, b.lo, c.lo), hn::MulAdd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D fnma(D a, D b, D c) {
    return {hn::NegMulAdd(a.lo, b.lo, c.lo), hn::NegMulAdd(a.hi, b.hi, c.hi)};
}
GRAINSWEEP_LANES D min(D a, D b) {
    return {hn::Min(a.lo, b.lo), hn::Min(a.hi, b.hi)};
}
GRAINSWEEP_LANES D max(D a, D b) {
    return {hn::Max(a.lo, b.lo), hn::Max(a.hi, b.hi)};
}
GRAINSWEEP_LANES D sqrt(D a) {
    return {hn::Sqrt(a.lo), hn::Sqrt(a.hi)};
}
GRAINSWEEP_LANES D nearest_integer(D a) {
    return {hn::Round(a.lo), hn::Round(a.hi)};
}
/// a < b ? c : d, lane by lane
GRAINSWEEP_LANES D where_less(D a, D b, D c, D d) {
    return {hn::IfThenElse(hn::Lt(a.lo, b.lo), c.lo, d.lo), hn::IfThenElse(hn::Lt(a.hi, b.hi), c.hi, d.hi)};
}

GRAINSWEEP_LANES M operator<(F a, F b) {
    return {hn::Lt(a.v, b.v)};
}
GRAINSWEEP_LANES M operator&(M a, M b) {
    return {hn::And(a.v, b.v)};
}
GRAINSWEEP_LANES M operator|(M a, M b) {
    return {hn::Or(a.v, b.v)};
}
GRAINSWEEP_LANES F keep(M m, F a) {
    return {hn::IfThenElseZero(m.v, a.v)};
}
GRAINSWEEP_LANES F drop(M m, F a) {
#if HWY_CAP_GE512  // Highway's Not moves the mask to a register and back, where the comparison could be the opposite
    return {hn::IfThenElseZero(hn::Mask<decltype(singles)>{static_cast<__mmask16>(~m.v.raw)}, a.v)};
#else
    return {hn::IfThenZeroElse(m.v, a.v)};
#endif
}
GRAINSWEEP_LANES F select(M m, F a, F b) {
    return {hn::IfThenElse(m.v, a.v, b.v)};
}
GRAINSWEEP_LANES unsigned bits(M m) {
    std::uint64_t b = 0;
    hn::StoreMaskBits(singles, m.v, reinterpret_cast<std::uint8_t*>(&b));
    return static_cast<unsigned>(b);
}
GRAINSWEEP_LANES unsigned sign_bits(I a) {
    return bits({hn::MaskFromVec(hn::BitCast(singles, hn::BroadcastSignBit(a.v)))});
}
GRAINSWEEP_LANES float largest(F a) {
    return hn::GetLane(hn::MaxOfLanes(singles, a.v));
}

/// Returns the lanes whose bit is set.
GRAINSWEEP_LANES M lanes_in(unsigned m) {
    const std::uint64_t b = m;
    return {hn::LoadMaskBits(singles, reinterpret_cast<const std::uint8_t*>(&b))};
}
/// Selected lanes in the form that the move instructions need: a mask for AVX-512, bits for others.
struct Chosen {
    M mask;
    unsigned bits;
    GRAINSWEEP_LANES explicit Chosen(M m) : mask(m), bits(fast::bits(m)) {}
};
// compress: moves the lanes whose bit is set to the front; the lanes behind them are arbitrary. The inverse fills other
// lanes with zero. The tables are defined here because those of Highway 1.0 are local to its functions and GCC copies
// them at every use.
#if HWY_CAP_GE512
template <class Lanes>
GRAINSWEEP_LANES Lanes compress(Lanes a, M m) {
    return {hn::Compress(a.v, hn::RebindMask(hn::DFromV<decltype(a.v)>{}, m.v))};
}
template <class Lanes>
GRAINSWEEP_LANES Lanes compress(Lanes a, unsigned m) {
    return compress(a, lanes_in(m));
}
template <class Lanes>
GRAINSWEEP_LANES Lanes compress(Lanes a, Chosen c) {
    return compress(a, c.mask);
}
GRAINSWEEP_LANES F expand(F a, unsigned m) {
    return {Vector<float, width>{_mm512_maskz_expand_ps(static_cast<__mmask16>(m), a.v.raw)}};
}
#else
/// Source of every lane for each mask: lane numbers of 4 bits, or byte numbers (0x80: zero).
struct LaneTables {
#if HWY_CAP_GE256
    std::uint32_t front[1 << width], spread[1 << width];
    constexpr static void set(std::uint32_t& of_mask, unsigned to, unsigned from) {
        of_mask |= from << (4 * to);
    }
#else
    struct alignas(16) Bytes {
        std::uint8_t from[16] = {128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128};
    } front[1 << width], spread[1 << width];
    constexpr static void set(Bytes& of_mask, unsigned to, unsigned from) {
        for (unsigned b = 0; b < 4; ++b) of_mask.from[4 * to + b] = static_cast<std::uint8_t>(4 * from + b);
    }
#endif
};
constexpr LaneTables make_lane_tables() {
    LaneTables t{};
    for (unsigned m = 0; m < 1U << width; ++m) {
        unsigned front = 0;
        for (unsigned lane = 0; lane < width; ++lane) {
            if (((m >> lane) & 1) == 0) continue;
            LaneTables::set(t.front[m], front, lane);
            LaneTables::set(t.spread[m], lane, front);
            ++front;
        }
    }
    return t;
}
constexpr LaneTables lane_tables = make_lane_tables();

#if HWY_CAP_GE256
template <class Lanes>
GRAINSWEEP_LANES Lanes moved(Lanes a, std::uint32_t order) {
    alignas(32) static constexpr std::uint32_t shifts[8] = {0, 4, 8, 12, 16, 20, 24, 28};
    const Tag<std::uint32_t, width> words;  // permute instructions read the low three bits
    return {hn::TableLookupLanes(
        a.v, hn::IndicesFromVec(hn::DFromV<decltype(a.v)>{}, hn::Shr(hn::Set(words, order), hn::Load(words, shifts))))};
}
#else
template <class Lanes>
GRAINSWEEP_LANES Lanes moved(Lanes a, const LaneTables::Bytes& order) {
    const Tag<std::uint8_t, 16> bytes;
    return {hn::BitCast(hn::DFromV<decltype(a.v)>{},
                        hn::TableLookupBytesOr0(hn::BitCast(bytes, a.v), hn::Load(bytes, order.from)))};
}
#endif
template <class Lanes>
GRAINSWEEP_LANES Lanes compress(Lanes a, unsigned m) {
    return moved(a, lane_tables.front[m]);
}
template <class Lanes>
GRAINSWEEP_LANES Lanes compress(Lanes a, Chosen c) {
    return compress(a, c.bits);
}
GRAINSWEEP_LANES F expand(F a, unsigned m) {
    const F spread = moved(a, lane_tables.spread[m]);
#if HWY_CAP_GE256
    return keep(lanes_in(m), spread);
#else
    return spread;
#endif
}
#endif
/// Sets the sign of lanes whose bit is set.
GRAINSWEEP_LANES I with_sign_bits(I a, unsigned m) {
    return {hn::Or(a.v, hn::IfThenElseZero(hn::RebindMask(integers, lanes_in(m).v), hn::Set(integers, INT32_MIN)))};
}
GRAINSWEEP_LANES I lane_numbers() {
    return {hn::Iota(integers, 0)};
}

GRAINSWEEP_LANES const Record* record_at(const Record* r, Place p) {
    return reinterpret_cast<const Record*>(reinterpret_cast<const char*>(r) + std::uint64_t{p} * (sizeof(Record) / 8));
}
GRAINSWEEP_LANES Force* force_at(Force* f, Place p) {
    return reinterpret_cast<Force*>(reinterpret_cast<char*>(f) + std::uint64_t{p} * (sizeof(Force) / 8));
}
GRAINSWEEP_LANES void prefetch(const void* p) {
    __builtin_prefetch(p);
}
/// Prefetches a cache line for writing, which removes it from other cores.
GRAINSWEEP_LANES void prefetch_to_write(const void* p) {
    __builtin_prefetch(p, 1);
}
/// Writes past the caches; p must be a multiple of the vector's size.
GRAINSWEEP_LANES void stream(float* p, F a) {
    hn::Stream(a.v, singles, p);
}
/// Makes streamed values visible to other threads.
GRAINSWEEP_LANES void flush_streams() {
#if HWY_ARCH_X86
    _mm_sfence();
#else
    __atomic_thread_fence(__ATOMIC_RELEASE);
#endif
}

/// Returns in every lane the entry `at` of a table that fits a vector.
GRAINSWEEP_LANES F looked_up(F table, I at) {
    return {hn::TableLookupLanes(table.v, hn::IndicesFromVec(singles, at.v))};
}
GRAINSWEEP_LANES F gathered(const float* table, I at) {
    return {hn::GatherIndex(singles, table, at.v)};
}

}  // namespace
}  // namespace grainsweep::dem::fast
