#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::designs_lattice_test {

using Counts = std::vector<std::int64_t>;

TEST(Lattice, LastFactorRunsFastest) {
    const auto set = ask_design("lattice", 2, {{"levels", Counts{2, 3}}});
    EXPECT_EQ(set.coordinates, (std::vector<double>{0, 0, 0, 0.5, 0, 1, 1, 0, 1, 0.5, 1, 1}));
}

TEST(Lattice, CentredLevelsAreMiddlesOfCells) {
    const auto set = ask_design("lattice", 1, {{"levels", 4}, {"placement", "centred"}});
    EXPECT_EQ(set.coordinates, (std::vector<double>{0.125, 0.375, 0.625, 0.875}));
}

TEST(Lattice, OneLevelIsTheMiddle) {
    EXPECT_EQ(ask_design("lattice", 1, {{"levels", 1}}).coordinates, (std::vector<double>{0.5}));
}

TEST(Lattice, DeclaredLevelsAreHitExactly) {
    for (std::size_t k = 1; k <= 200; ++k) {
        const auto set = ask_design("lattice", std::vector<std::size_t>{k}, {});
        ASSERT_EQ(set.size(), k);
        for (std::size_t i = 0; i < k; ++i)
            EXPECT_EQ(std::floor(static_cast<double>(k) * set.point(i)[0]), static_cast<double>(i));
    }
}

TEST(Lattice, DeclaredLevelsMixWithAskedOnes) {
    const auto set = ask_design("lattice", std::vector<std::size_t>{0, 2}, {{"levels", 3}});
    EXPECT_EQ(set.coordinates, (std::vector<double>{0, 0.25, 0, 0.75, 0.5, 0.25, 0.5, 0.75, 1, 0.25, 1, 0.75}));
    EXPECT_EQ(ask_design("lattice", std::vector<std::size_t>{0, 2}, {{"levels", Counts{3, 2}}}).size(), 6U);
}

TEST(Lattice, SaysWhatCannotBe) {
    EXPECT_THROW((void)ask_design("lattice", 2, {}), std::invalid_argument);
    EXPECT_THROW((void)ask_design("lattice", 2, {{"levels", Counts{2, 3, 4}}}), std::invalid_argument);
    EXPECT_THROW((void)ask_design("lattice", std::vector<std::size_t>{0, 2}, {{"levels", Counts{3, 4}}}),
                 std::invalid_argument);
    EXPECT_THROW((void)ask_design("lattice", 12, {{"levels", 10}}), std::invalid_argument);
}

}  // namespace grainsweep::tests::designs_lattice_test
