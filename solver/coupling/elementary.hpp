// Exponential and logarithm as additions and multiplications, so that compilers can vectorise them and every processor
// returns the same bits. Errors are below 2 units in the last place (compared with the library in tests).
//
// e^x: x = n ln 2 + r, |r| <= ln 2/2, e^r - 1 by its Taylor series to r^13. ln x: x = 2^e m, sqrt(1/2) <= m < sqrt 2,
// ln m = 2 artanh s, s = (m - 1)/(m + 1), by its series to s^21 (Abramowitz & Stegun 1964, 4.2.1 and 4.1.27).
#pragma once

#include <bit>
#include <cstdint>

namespace grainsweep::coupling {

inline constexpr double ln2_high = 0x1.62e42fee00000p-1;  // exact when multiplied by an exponent
inline constexpr double ln2_low = 0x1.a39ef35793c76p-33;

/// Returns c0 + x (c1 + x (c2 + ...)).
template <double First, double... Rest>
[[nodiscard, gnu::always_inline]] inline double polynomial(double x) {
    if constexpr (sizeof...(Rest) == 0)
        return First;
    else
        return First + x * polynomial<Rest...>(x);
}

/// Result of exponential(): e^x = scale (1 + rest).
struct Exponential {
    double scale, rest;

    [[nodiscard, gnu::always_inline]] double value() const { return scale + scale * rest; }
    /// Returns e^x - 1, accurate near zero.
    [[nodiscard, gnu::always_inline]] double less_one() const { return scale * rest + (scale - 1); }
};

/// Returns e^x for x < 700; below -700 it is e^-700. NaN stays NaN.
[[gnu::always_inline]] inline Exponential exponential(double x) {
    constexpr double to_integer = 0x1.8p52;  // added, it leaves the nearest integer in the low bits
    x = x < -700 ? -700 : x;
    const double shifted = x * 1.4426950408889634 + to_integer;
    const double n = shifted - to_integer;
    const double r = (x - n * ln2_high) - n * ln2_low;
    const double tail = polynomial<1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
                                   1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800>(r);
    const auto exponent = std::bit_cast<std::uint64_t>(shifted) + 1023;
    return {std::bit_cast<double>(exponent << 52), r + r * r * tail};
}

/// Returns ln x for normal x > 0.
[[gnu::always_inline]] inline double logarithm(double x) {
    constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd;
    constexpr std::uint64_t bias = 1023;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t exponent = (bits - root_half + (bias << 52)) >> 52;  // e + bias
    const double e = std::bit_cast<double>(exponent | 0x4330000000000000) - (0x1p52 + 1023);
    const double m = std::bit_cast<double>(bits - (exponent << 52) + (bias << 52));
    const double s = (m - 1) / (m + 1);
    const double z = s * s;
    const double tail =
        polynomial<1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21>(z);
    return e * ln2_high + (2 * s + (2 * s * z * tail + e * ln2_low));
}

}  // namespace grainsweep::coupling
