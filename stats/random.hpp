// Addressed random numbers: a draw is a pure function of (seed, stream, counter).
//
// Every worker gets the same numbers, in any order and on any machine, and no state must be stored to resume.
// Mixing: SplitMix64 (Steele, Lea & Flood 2014, doi 10.1145/2714064.2660195), chained over the address.
#pragma once

#include <cstdint>
#include <vector>

namespace grainsweep::stats {

/// Returns one output of SplitMix64 started from state x.
[[nodiscard]] constexpr std::uint64_t splitmix64(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

/// Returns 64 random bits at an address.
[[nodiscard]] constexpr std::uint64_t bits_at(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
    std::uint64_t h = splitmix64(seed);
    h = splitmix64(h ^ stream);
    return splitmix64(h ^ counter);
}

/// Returns a number in [0, 1): the upper 53 bits divided by 2^53.
[[nodiscard]] constexpr double to_unit(std::uint64_t bits) {
    return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// Stream: all draws of one purpose; uniform(counter) is in [0, 1).
class Stream {
public:
    constexpr Stream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}
    [[nodiscard]] constexpr std::uint64_t bits(std::uint64_t counter) const { return bits_at(seed_, stream_, counter); }
    [[nodiscard]] constexpr double uniform(std::uint64_t counter) const { return to_unit(bits(counter)); }

private:
    std::uint64_t seed_;
    std::uint64_t stream_;
};

/// SplitMix64 sequence for an unknown number of draws (rejection, shuffles).
class Generator {
public:
    explicit constexpr Generator(std::uint64_t state) : state_(state) {}
    constexpr std::uint64_t next() {
        const std::uint64_t out = splitmix64(state_);
        state_ += 0x9E3779B97F4A7C15ULL;
        return out;
    }
    constexpr double uniform() { return to_unit(next()); }
    /// Returns a number in 0 ... n-1, uniform without bias by rejection; n >= 1.
    std::uint64_t below(std::uint64_t n);

private:
    std::uint64_t state_;
};

/// Returns a permutation of 0 ... n-1, the same on every platform (Fisher-Yates from the last place down).
[[nodiscard]] std::vector<std::uint32_t> permutation(std::uint32_t n, Generator generator);

}  // namespace grainsweep::stats
