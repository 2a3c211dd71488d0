#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace grainsweep;
using grainsweep::testing::ask_design;

TEST(Catalogue, EveryKindSaysWhatItIsAndExtendsWhereItClaims) {
    for (const auto& info : designs::design_catalogue()) {
        EXPECT_GT(info.summary.size(), 60U) << info.name;
        if (info.name == "list" || info.name == "lattice") continue;
        const std::string counter = info.options.front().name;  // the required count
        const auto few = ask_design(info.name, 3, {{counter, 16}}, 9);
        const auto many = ask_design(info.name, 3, {{counter, 64}}, 9);
        EXPECT_GT(many.size(), few.size());
        EXPECT_EQ(info.extends, std::equal(few.coordinates.begin(), few.coordinates.end(), many.coordinates.begin()))
            << info.name;
        EXPECT_TRUE(std::ranges::all_of(many.coordinates, [](double u) { return u >= 0 && u <= 1; })) << info.name;
    }
}

TEST(Catalogue, OnlyRandomisedSequencesAreIndependent) {
    for (const auto& info : designs::design_catalogue())
        EXPECT_EQ(info.independent_sequences, info.name == "halton" || info.name == "sobol") << info.name;
}

TEST(Catalogue, TooManyCoordinatesAreRefusedBeforeMemoryRunsOut) {
    EXPECT_THROW((void)ask_design("random", 1000, {{"points", 100'000'000}}), std::invalid_argument);
}

TEST(Catalogue, MissingOrMistypedOptionsAreNamed) {
    const designs::DesignInfo* halton = designs::find_design("halton");
    ASSERT_NE(halton, nullptr);
    EXPECT_EQ(designs::find_design("no_such_kind"), nullptr);
    try {
        (void)halton->sample({.levels = {0, 0}, .options = {{"points", std::string("many")}}, .seed = 1});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("sequences"), std::string::npos) << error.what();
    }
}
