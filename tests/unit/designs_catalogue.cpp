#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grainsweep::tests::designs_catalogue_test {

TEST(Catalogue, EveryKindSaysWhatItIsAndExtendsWhereItClaims) {
    for (const auto& info : designs::design_catalogue()) {
        EXPECT_GT(info.summary.size(), 60U) << info.name;
        if (info.name == "list" || info.name == "lattice" || info.grows) continue;
        const std::string counter(info.options.front().name);  // the required count
        const auto few = ask_design(info.name, 3, {{counter, 16}}, 9);
        const auto many = ask_design(info.name, 3, {{counter, 64}}, 9);
        EXPECT_GT(many.size(), few.size());
        EXPECT_EQ(info.extends, std::equal(few.coordinates.begin(), few.coordinates.end(), many.coordinates.begin()))
            << info.name;
        EXPECT_TRUE(std::ranges::all_of(many.coordinates, [](double u) { return u >= 0 && u <= 1; })) << info.name;
    }
}

// Others ask the size of a request without forming its points, and how many points belong together.
TEST(Catalogue, TheSizeIsThatOfTheSample) {
    for (const auto& info : designs::design_catalogue()) {
        designs::DesignRequest request{.levels = {0, 0, 3}, .options = {}, .seed = 3};
        for (const char* name : {"a", "b", "c"}) request.factors.push_back({name, {}});
        request.factors[2].range = designs::Levels{{0.0, 1.0, 2.0}};
        if (info.grows) {
            request.levels[1] = 2;
            request.factors[1].range = designs::Levels{{0.0, 1.0}};
        }
        designs::add_defaults(info, request.options);
        for (const auto& option : info.options) {
            auto& value = request.options[std::string(option.name)];
            if (option.kind == Field::Kind::whole && option.extent) value = std::int64_t{24};
            if (option.kind == Field::Kind::value) value = std::int64_t{4};
            if (option.kind == Field::Kind::array) value = designs::Rows(5, std::vector<Value>(3, Value{0.5}));
            if (option.kind == Field::Kind::number) value = 0.5;
            if (option.names == designs::OptionSpec::Names::factors) value = std::string("a");
            if (option.names == designs::OptionSpec::Names::observables) value = std::string("y");
        }
        const auto points = info.sample(request);
        EXPECT_EQ(info.size(request), static_cast<std::int64_t>(points.size())) << info.name;
        EXPECT_EQ(points.size() % info.block(3), 0U) << info.name;
        EXPECT_TRUE(info.grows || std::ranges::any_of(info.options, &designs::OptionSpec::extent)) << info.name;
    }
    EXPECT_EQ(designs::design_named("saltelli").block(3), 5U);
    EXPECT_EQ(designs::design_named("morris").block(3), 4U);
    EXPECT_THROW((void)designs::design_named("no_such_kind"), std::logic_error);
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

}  // namespace grainsweep::tests::designs_catalogue_test
