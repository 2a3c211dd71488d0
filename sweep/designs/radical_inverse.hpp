// Radical inverses: the digits of a whole number mirrored at the point, with one prime base per factor.
//
//   x_b(i) = sum_l p_l(d_l(i)) b^(-l-1),   d_l: digits of i, least significant first; p_l: a permutation
//
// plain (Halton 1960): p_l = identity. Braaten & Weller (1979): one fixed permutation per base with
// p(0) = 0. random (Owen 2017, arXiv:1706.02808): an independent uniform permutation per digit level, leading
// zeros included, so that every point is uniform and sequences of different seeds are independent.
//
// The sum is computed as a whole number, with the denominator b^m, m the largest power with b^m <= 2^53, and divided
// once. The result is the double nearest to the exact value, with the same bits on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::designs {

/// Returns the first `count` primes: 2, 3, 5, ...
[[nodiscard]] std::vector<std::uint32_t> primes(std::size_t count);

/// Returns the state of the generator that shuffles one digit level: SplitMix64 chained over (seed, sequence, factor
/// from 0, level from 0, which is the least significant digit).
[[nodiscard]] std::uint64_t scrambling_key(std::uint64_t seed, std::uint64_t sequence, std::uint64_t factor,
                                           std::uint64_t level);

/// Coordinate of one factor as a function of the index.
class RadicalInverse {
public:
    /// Returns the plain inverse; base >= 2, at most 2^26.
    [[nodiscard]] static RadicalInverse plain(std::uint32_t base);
    /// Returns the inverse with the same permutation of 0 ... base-1 at every level; permutation[0] must be 0.
    [[nodiscard]] static RadicalInverse permuted(std::span<const std::uint8_t> permutation);
    [[nodiscard]] static RadicalInverse random(std::uint32_t base, std::uint64_t seed, std::uint64_t sequence,
                                               std::uint64_t factor);

    /// Returns x(index) in [0, 1). Throws std::invalid_argument from index b^m on (at least 2^53 / b).
    [[nodiscard]] double operator()(std::uint64_t index) const;

    [[nodiscard]] std::size_t levels() const { return rest_.size() - 1; }
    [[nodiscard]] std::uint64_t denominator() const { return denominator_; }

private:
    explicit RadicalInverse(std::uint32_t base);
    /// Sets p_l: digit -> share of the numerator.
    void set_level(std::size_t level, std::span<const std::uint32_t> permutation);
    void sum_rests();

    std::uint32_t base_;
    std::uint64_t denominator_ = 1;    ///< b^m
    std::vector<std::uint64_t> part_;  ///< p_l(d) b^(m-1-l) at l b + d
    std::vector<std::uint64_t> rest_;  ///< contribution of the leading zeros from level l on
};

}  // namespace grainsweep::designs
