// The Sobol sequence with the direction numbers of Joe & Kuo (2008), SIAM J. Sci. Comput. 30, 2635-2654, as in
// Boost.Random. Only this file includes them, so that the templates are compiled once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace grainsweep::stats {

/// Sequence of points in Gray-code order, without the point of index 0, which is all zero.
class SobolSequence {
public:
    /// `dimensions`: 1 to most_dimensions().
    explicit SobolSequence(std::size_t dimensions);
    SobolSequence(const SobolSequence&) = delete;
    SobolSequence& operator=(const SobolSequence&) = delete;
    ~SobolSequence();

    /// Returns the next coordinate times 2^64. The coordinates of one point come one after another.
    [[nodiscard]] std::uint64_t next();
    /// Returns the next coordinate.
    [[nodiscard]] double next_fraction() { return static_cast<double>(next()) * 0x1p-64; }

    [[nodiscard]] static std::size_t most_dimensions();

private:
    struct Engine;
    std::unique_ptr<Engine> engine_;
};

/// Binary digits of a scrambled fraction.
inline constexpr unsigned scrambled_digits = 53;

/// Applies Owen's (1995) nested uniform scrambling to a fraction of 53 binary digits. Digit l is flipped by a random
/// bit addressed by the key and the digits before it, so other keys give independent scramblings.
[[nodiscard]] std::uint64_t owen_scrambled(std::uint64_t fraction, std::uint64_t key);
/// Returns owen_scrambled() as a number in [0, 1).
[[nodiscard]] inline double scrambled_unit(std::uint64_t fraction, std::uint64_t key) {
    return static_cast<double>(owen_scrambled(fraction, key)) * 0x1p-53;
}

}  // namespace grainsweep::stats
