#include "sweep/designs/radical_inverse.hpp"

#include "stats/random.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <stdexcept>
#include <string>

namespace grainsweep::designs {

std::vector<std::uint32_t> primes(std::size_t count) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t candidate = 2; found.size() < count; ++candidate) {
        const bool divisible =
            std::ranges::any_of(found, [&](std::uint32_t p) { return p <= candidate / p && candidate % p == 0; });
        if (!divisible) found.push_back(candidate);
    }
    return found;
}

std::uint64_t scrambling_key(std::uint64_t seed, std::uint64_t sequence, std::uint64_t factor, std::uint64_t level) {
    std::uint64_t h = 0;
    for (const std::uint64_t part : {seed, sequence, factor, level}) h = stats::splitmix64(h ^ part);
    return h;
}

RadicalInverse::RadicalInverse(std::uint32_t base) : base_(base) {
    assert(base >= 2 && base <= (1U << 26U));
    constexpr std::uint64_t most = 1ULL << 53U;
    std::size_t m = 0;
    for (; denominator_ <= most / base; ++m) denominator_ *= base;
    part_.resize(m * base);
    rest_.assign(m + 1, 0);
}

void RadicalInverse::set_level(std::size_t level, std::span<const std::uint32_t> permutation) {
    std::uint64_t weight = denominator_;
    for (std::size_t l = 0; l <= level; ++l) weight /= base_;
    for (std::size_t digit = 0; digit < base_; ++digit) part_[level * base_ + digit] = permutation[digit] * weight;
}

void RadicalInverse::sum_rests() {
    for (std::size_t l = levels(); l-- > 0;) rest_[l] = rest_[l + 1] + part_[l * base_];
}

RadicalInverse RadicalInverse::plain(std::uint32_t base) {
    RadicalInverse inverse(base);
    std::vector<std::uint32_t> identity(base);
    std::iota(identity.begin(), identity.end(), 0U);
    for (std::size_t l = 0; l < inverse.levels(); ++l) inverse.set_level(l, identity);
    return inverse;
}

RadicalInverse RadicalInverse::permuted(std::span<const std::uint8_t> permutation) {
    assert(permutation.front() == 0);
    RadicalInverse inverse(static_cast<std::uint32_t>(permutation.size()));
    const std::vector<std::uint32_t> wide(permutation.begin(), permutation.end());
    for (std::size_t l = 0; l < inverse.levels(); ++l) inverse.set_level(l, wide);
    return inverse;
}

RadicalInverse RadicalInverse::random(std::uint32_t base, std::uint64_t seed, std::uint64_t sequence,
                                      std::uint64_t factor) {
    RadicalInverse inverse(base);
    for (std::size_t l = 0; l < inverse.levels(); ++l)
        inverse.set_level(l, stats::permutation(base, stats::Generator(scrambling_key(seed, sequence, factor, l))));
    inverse.sum_rests();
    return inverse;
}

double RadicalInverse::operator()(std::uint64_t index) const {
    if (index >= denominator_)
        throw std::invalid_argument("index " + std::to_string(index) + " is beyond the last exact point of base " +
                                    std::to_string(base_) + ", " + std::to_string(denominator_ - 1));
    std::uint64_t numerator = 0;
    std::size_t level = 0;
    for (; index != 0; ++level) {
        const std::uint64_t next = index / base_;
        numerator += part_[level * base_ + (index - next * base_)];
        index = next;
    }
    return static_cast<double>(numerator + rest_[level]) / static_cast<double>(denominator_);
}

}  // namespace grainsweep::designs
