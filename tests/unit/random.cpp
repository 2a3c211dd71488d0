#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace grainsweep::tests::random_test {

using namespace stats;

TEST(Random, SplitMix64GivesThePublishedSequence) {
    // First outputs from state 1234567, as published with the generator.
    Generator generator(1234567);
    EXPECT_EQ(generator.next(), 6457827717110365317ULL);
    EXPECT_EQ(generator.next(), 3203168211198807973ULL);
    EXPECT_EQ(generator.next(), 9817491932198370423ULL);
}

TEST(Random, PermutationIsABijection) {
    auto p = permutation(97, Generator(5));
    std::ranges::sort(p);
    for (std::uint32_t i = 0; i < 97; ++i) EXPECT_EQ(p[i], i);
}

TEST(Random, AddressesDoNotCollide) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        for (std::uint64_t stream = 0; stream < 20; ++stream)
            for (std::uint64_t counter = 0; counter < 20; ++counter) seen.insert(bits_at(seed, stream, counter));
    EXPECT_EQ(seen.size(), 8000U);
}

}  // namespace grainsweep::tests::random_test
