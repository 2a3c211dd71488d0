#include "stats/random.hpp"
#include "sweep/designs/radical_inverse.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <set>

namespace grainsweep::tests::designs_halton_test {

using namespace designs;

TEST(Halton, PlainPointsAreMirroredDigits) {
    const auto set = ask_design("halton", 3, {{"points", 4}, {"scramble", "none"}});
    const std::vector<double> expected = {1.0 / 2, 1.0 / 3, 1.0 / 5, 1.0 / 4, 2.0 / 3, 2.0 / 5,
                                          3.0 / 4, 1.0 / 9, 3.0 / 5, 1.0 / 8, 4.0 / 9, 4.0 / 5};
    EXPECT_EQ(set.coordinates, expected);
}

TEST(Halton, ExactUpToTheLastIndexOfABase) {
    const auto inverse = RadicalInverse::plain(97);
    EXPECT_EQ(inverse.levels(), 8U);
    EXPECT_EQ(inverse(inverse.denominator() - 1),
              static_cast<double>(inverse.denominator() - 1) / static_cast<double>(inverse.denominator()));
    EXPECT_LT(inverse(inverse.denominator() - 1), 1.0);
    EXPECT_THROW((void)inverse(inverse.denominator()), std::invalid_argument);
}

TEST(Halton, ScramblingKeysFollowTheSpecification) {
    EXPECT_EQ(scrambling_key(1, 0, 0, 0), 16321491304643971414ULL);
    EXPECT_EQ(scrambling_key(1, 0, 0, 1), 4585330820673184961ULL);
    EXPECT_EQ(scrambling_key(1, 2, 3, 4), 15374388949593934587ULL);
    EXPECT_EQ(stats::permutation(7, stats::Generator(scrambling_key(1, 0, 3, 0))),
              (std::vector<std::uint32_t>{6, 0, 4, 2, 3, 1, 5}));
    EXPECT_EQ(stats::permutation(19, stats::Generator(scrambling_key(1, 0, 7, 1))),
              (std::vector<std::uint32_t>{6, 0, 1, 11, 10, 9, 2, 7, 5, 4, 17, 18, 13, 14, 12, 15, 3, 8, 16}));
}

TEST(Halton, RandomScramblingKeepsEveryDigitBalanced) {
    // Any b^k consecutive indices from a multiple of b^k visit each of the b^k cells once.
    for (const std::uint32_t base : {2U, 3U, 7U}) {
        const auto inverse = RadicalInverse::random(base, 42, 3, 1);
        std::set<std::uint32_t> cells;
        const std::uint32_t count = base * base * base;
        for (std::uint32_t i = 0; i < count; ++i)
            cells.insert(static_cast<std::uint32_t>(inverse(5 * count + i) * count));
        EXPECT_EQ(cells.size(), count);
    }
}

TEST(Halton, SequencesAdvanceTogetherAndExtendPointByPoint) {
    const auto few = ask_design("halton", 4, {{"points", 20}, {"sequences", 8}}, 5);
    const auto many = ask_design("halton", 4, {{"points", 83}, {"sequences", 8}}, 5);
    EXPECT_EQ(few.sequences, 8U);
    EXPECT_TRUE(std::equal(few.coordinates.begin(), few.coordinates.end(), many.coordinates.begin()));
    for (std::size_t p = 0; p < many.size(); ++p)
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_EQ(many.point(p)[j], RadicalInverse::random(primes(4)[j], 5, p % 8, j)(1 + p / 8));
}

TEST(Halton, SaysWhatCannotBe) {
    EXPECT_THROW((void)ask_design("halton", 2, {{"points", 8}, {"sequences", 4}, {"scramble", "none"}}),
                 std::invalid_argument);
    EXPECT_THROW((void)ask_design("halton", 26, {{"points", 8}, {"scramble", "braaten_weller"}}),
                 std::invalid_argument);
    EXPECT_THROW((void)ask_design("halton", 17, {{"points", 8}, {"scramble", "braaten_weller_vc2006"}}),
                 std::invalid_argument);
    EXPECT_EQ(ask_design("halton", 40, {{"points", 8}}).size(), 8U);
    EXPECT_THROW((void)ask_design("halton", 10'000, {{"points", 8}}), std::invalid_argument) << "a minute";
    EXPECT_THROW((void)ask_design("halton", 1001, {{"points", 8}, {"scramble", "none"}}), std::invalid_argument);
}

}  // namespace grainsweep::tests::designs_halton_test
