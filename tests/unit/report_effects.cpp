// Main effects and histograms: equal bins, and whiskers that are what they say.
#include "sweep/study/effects.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace grainsweep::tests::report_effects_test {

using namespace study;

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Effects, HistogramHoldsEveryFiniteValue) {
    std::vector<double> values = {none, 1, 2, 2, 3, 5, std::numeric_limits<double>::infinity()};
    const auto histogram = study::histogram_of(values);
    EXPECT_EQ(histogram.low, 1);
    EXPECT_EQ(histogram.high, 5);
    EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::int64_t{0}), 5);
    EXPECT_EQ(histogram.counts.back(), 1);
    EXPECT_THAT(study::histogram_of(std::vector<double>(4, 7.0)).counts, ElementsAre(4));
    EXPECT_TRUE(study::histogram_of(std::vector<double>{none}).counts.empty());
}

TEST(Effects, BinsHoldEqualCountsAndLevelsAreBins) {
    study::FactorColumn factor;
    std::vector<double> response;
    for (int i = 0; i < 320; ++i) {
        factor.values.push_back(i / 320.0);
        response.push_back(3 * i / 320.0);
    }
    response[7] = none;
    study::EffectErrors errors;
    errors.source = study::EffectErrors::Source::parts;
    for (int i = 0; i < 320; ++i) errors.parts.push_back(static_cast<std::size_t>(i % 8));
    const auto effect = main_effect(factor, response, errors);
    ASSERT_EQ(effect.size(), 16u);
    std::int64_t total = 0;
    for (const auto& bin : effect) {
        EXPECT_NEAR(bin.mean, 3 * bin.at, 1e-12);
        EXPECT_GT(bin.error, 0);
        total += bin.count;
    }
    EXPECT_EQ(total, 319);

    factor.seen = {"a", "b"};
    factor.range = campaign::Levels{factor.seen};
    for (std::size_t i = 0; i < factor.values.size(); ++i) factor.values[i] = i % 2 == 0 ? 0 : 1;
    const auto levels = main_effect(factor, response, errors);
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_EQ(levels[1].at, 1);
    EXPECT_EQ(levels[0].count, 160);
    EXPECT_EQ(levels[1].count, 159);
}

// Two levels of a share that the other factor moves from 0 to 1: the values at a level differ by that factor, which is
// no error of their mean.
TEST_F(Study, MainEffectsOfALatticeOfSingleRunsHaveNoWhiskers) {
    answer_by(store, lattice("c", 1), [](const Inputs& inputs) { return input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto errors = effect_errors(responses, y);
    EXPECT_EQ(errors.source, study::EffectErrors::Source::none);
    EXPECT_THAT(errors.says, HasSubstr("a lattice of single runs gives no error; replicates would"));
    for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), errors)) {
        EXPECT_DOUBLE_EQ(bin.mean, 0.5);
        EXPECT_TRUE(std::isnan(bin.error));
    }
}

TEST_F(Study, MainEffectsOfAReplicatedLatticeHaveTheErrorOfTheirScatter) {
    constexpr double sigma = 0.05;
    std::uint64_t count = 0;
    int covered = 0, bins = 0;
    for (int k = 0; k < 40; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, lattice(name, 3).insert(1, R"("seed": )" + std::to_string(k + 1) + ", "),
                  [&](const Inputs& inputs) { return disturbed(input(inputs, "x2"), sigma, 5, ++count); });
        const auto responses = ask(name);
        const auto& y = responses.observable("y");
        const auto errors = effect_errors(responses, y);
        EXPECT_EQ(errors.pure.freedom, 20);  // 10 points, 3 runs each
        EXPECT_THAT(errors.says, HasSubstr("pure error, 20 degrees of freedom"));
        for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), errors)) {
            EXPECT_EQ(bin.count, 15);
            EXPECT_NEAR(bin.error, 2.086 * std::sqrt(errors.pure.variance / 15), 1e-4);
            covered += std::abs(bin.mean - 0.5) <= bin.error;
            ++bins;
        }
    }
    EXPECT_EQ(bins, 80);
    EXPECT_GE(covered, 70);  // 95 % of 80 is 76, three standard errors are 5.8
}

TEST_F(Study, MainEffectsOfASampleCoverTheTruthAsOftenAsTheySay) {
    // y = x1 + 2 x2 + 0.5 over x2 in [0, 0.5]: in a bin of x1 the mean is x1 + 1.
    int covered = 0, bins = 0;
    for (int k = 0; k < 12; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, halton(name, 320, R"(, "seed": )" + std::to_string(k + 1)),
                  [](const Inputs& inputs) { return input(inputs, "x1") + 2 * input(inputs, "x2") + 0.5; });
        const auto responses = ask(name);
        const auto& y = responses.observable("y");
        for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), effect_errors(responses, y))) {
            covered += std::abs(bin.mean - bin.at - 1) <= bin.error;
            ++bins;
        }
    }
    EXPECT_EQ(bins, 192);
    EXPECT_GE(covered, 173);  // 95 % less three standard errors
}

TEST_F(Study, AWhiskerNeedsFourPartsOfTheSample) {
    answer_by(store, halton("c", 16), [](const Inputs& inputs) { return linear(inputs); });
    auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto errors = effect_errors(responses, y);
    auto& factor = responses.factors[0];
    factor.seen = {"a", "b"};
    factor.range = campaign::Levels{factor.seen};
    for (std::size_t row = 0; row < 16; ++row) factor.values[row] = row < 3 ? 0 : 1;
    const auto bins = main_effect(factor, responses.judged(y), errors);
    EXPECT_TRUE(std::isnan(bins[0].error));
    EXPECT_GT(bins[1].error, 0);
}

}  // namespace grainsweep::tests::report_effects_test
