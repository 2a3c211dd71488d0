#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>

namespace grainsweep::tests::designs_sobol_test {

TEST(Sobol, UnscrambledBeginsAsPublished) {
    const auto set = ask_design("sobol", 3, {{"points", 4}, {"scramble", "none"}});
    EXPECT_EQ(set.coordinates, (std::vector<double>{0, 0, 0, 0.5, 0.5, 0.5, 0.75, 0.25, 0.25, 0.25, 0.75, 0.75}));
}

TEST(Sobol, ScramblingKeepsTheNet) {
    // The first two dimensions of Sobol's sequence are a (0, 2)-sequence: 2^6 points put exactly one into
    // every elementary box of area 2^-6, and Owen's scrambling preserves that (Owen 1995, prop. 1).
    const auto set = ask_design("sobol", 2, {{"points", 128}, {"sequences", 2}}, 77);
    for (std::size_t sequence = 0; sequence < 2; ++sequence)
        for (unsigned k = 0; k <= 6; ++k) {
            std::set<std::pair<int, int>> boxes;
            for (std::size_t p = sequence; p < 128; p += 2)
                boxes.emplace(static_cast<int>(set.point(p)[0] * (1U << k)),
                              static_cast<int>(set.point(p)[1] * (1U << (6U - k))));
            EXPECT_EQ(boxes.size(), 64U) << "k = " << k;
        }
}

TEST(Sobol, ScramblingIsUniformPointByPoint) {
    // Over many seeds, one and the same point is uniform in each factor: mean 1/2, variance 1/12.
    double sum = 0;
    double squares = 0;
    constexpr int seeds = 2000;
    for (int seed = 0; seed < seeds; ++seed) {
        const double u = ask_design("sobol", 2, {{"points", 6}}, static_cast<std::uint64_t>(seed)).point(5)[1];
        sum += u / seeds;
        squares += (u - 0.5) * (u - 0.5) / seeds;
    }
    EXPECT_NEAR(sum, 0.5, 4 * 0.2887 / std::sqrt(seeds));
    EXPECT_NEAR(squares, 1.0 / 12, 4 * 0.0745 / std::sqrt(seeds));
}

TEST(Sobol, SequencesShareNoScrambling) {
    const auto set = ask_design("sobol", 2, {{"points", 8}, {"sequences", 4}});
    const std::set<double> firsts = {set.point(0)[0], set.point(1)[0], set.point(2)[0], set.point(3)[0]};
    EXPECT_EQ(firsts.size(), 4U);
    EXPECT_THROW((void)ask_design("sobol", 2, {{"points", 8}, {"sequences", 4}, {"scramble", "none"}}),
                 std::invalid_argument);
}

}  // namespace grainsweep::tests::designs_sobol_test
