// Influences: indices of designs of every kind, what they leave unexplained, and which way a response goes.
#include "sweep/report/influence_tables.hpp"
#include "sweep/study/effects.hpp"
#include "sweep/study/influence.hpp"
#include "tests/support/study.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainsweep::tests::report_influence_test {

using namespace report;
using namespace study;

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(Study, SharesOfTheVarianceFromAnyDesign) {
    answer_by(store, halton("c", 1600), [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.method, study::Influence::Method::given_data);
    EXPECT_EQ(influence.factors[0].bins, 16u);
    EXPECT_EQ(influence.used, 1600);
    EXPECT_NEAR(influence.factors[0].first.value, 0.8, 0.01);
    EXPECT_NEAR(influence.factors[1].first.value, 0.2, 0.01);
    EXPECT_GT(influence.factors[0].first.half_width, 0);
    EXPECT_LT(influence.factors[0].first.half_width, 0.05);
    const auto table = influence_table(influence);
    EXPECT_EQ(text_of(table.rows[0][0]), "x1");
}

TEST_F(Study, ALatticeTellsItsIndicesLineByLine) {
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}], "design": {"kind": "lattice", "levels": 7}})",
              [](const Inputs& inputs) { return std::abs(input(inputs, "x1") - 0.5) + 0.01 * input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.factors[0].bins, 7u);
    // An additive response: the indices are shares of the lattice's own variance and add up to 1.
    EXPECT_NEAR(influence.factors[0].first.value + influence.factors[1].first.value, 1, 1e-12);
    EXPECT_GT(influence.factors[0].first.value, 0.99);
    EXPECT_TRUE(std::isnan(influence.factors[0].first.half_width));
}

TEST_F(Study, ValuesWhoseSquaresOverflowHaveNoSharesButAReason) {
    for (const auto& [name, unit] : {std::pair("far", 1e160), {"little", 1e-160}, {"fourth", 1e90}}) {
        // Seeds differ, because equal cases of two campaigns share their answers.
        const auto seed = std::to_string(std::abs(std::ilogb(unit)));
        answer_by(store, halton(name, 128, R"(, "seed": )" + seed + (unit < 1 ? "1" : "")),
                  [unit = unit](const Inputs& inputs) { return unit * linear(inputs); });
        const auto responses = ask(name);
        const auto influence = influence_of(responses, responses.observable("y"));
        const auto history = history_of(responses, responses.observable("y"));
        EXPECT_NEAR(history.all.of(stats::Statistic::mean).error / unit, 0.05, 0.05) << "is known all the same";
        if (unit == 1e90) {
            EXPECT_NEAR(influence.factors[0].first.value, 0.8, 0.1);
            EXPECT_THAT(history.warnings, Contains(HasSubstr("no g1 and kurtosis: the values from 1")));
            continue;
        }
        EXPECT_EQ(unexplained_text(influence), "");
        EXPECT_THAT(influence.notes, Contains(HasSubstr("no shares of the variance: the values from ")));
        EXPECT_THAT(history.warnings, Contains(HasSubstr(" that sums of their squares leave the range of double")));
    }
}

TEST_F(Study, TotalIndicesFromSaltelliAndElementaryEffectsFromMorris) {
    const std::string factors = R"("scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 0.5]}], )";
    answer_by(store, R"({"campaign": "s", )" + factors + R"("design": {"kind": "saltelli", "base_points": 512}})",
              [](const Inputs& inputs) { return input(inputs, "x1") * input(inputs, "x2"); });
    auto responses = ask("s");
    const auto saltelli = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(saltelli.method, study::Influence::Method::saltelli);
    EXPECT_EQ(saltelli.used, 512);
    // y = u1 u2 / 2: both first-order indices 3/7, both total indices 4/7.
    for (const auto& factor : saltelli.factors) {
        EXPECT_NEAR(factor.first.value, 3.0 / 7, 0.02) << factor.factor;
        EXPECT_NEAR(factor.first_saltelli.value, 3.0 / 7, 0.06) << factor.factor;
        EXPECT_NEAR(factor.total.value, 4.0 / 7, 0.03) << factor.factor;
    }

    EXPECT_THAT(saltelli.notes, Contains(HasSubstr("every total index holds the scatter of single runs")));

    // With a scatter of variance 1/144 about y, of variance 7/576, means of two runs have 2/9 of theirs from the
    // scatter.
    std::uint64_t run = 0;
    answer_by(store,
              R"({"campaign": "r", )" + factors +
                  R"("design": {"kind": "saltelli", "base_points": 512}, "replicates": 2, "seed": 2})",
              [&](const Inputs& inputs) {
                  const double u = stats::Stream(7, 0).uniform(++run);
                  return input(inputs, "x1") * input(inputs, "x2") + std::sqrt(12.0) / 12 * (u - 0.5);
              });
    responses = ask("r");
    EXPECT_THAT(influence_of(responses, responses.observable("y")).notes,
                Contains(HasSubstr("total indices are of means over 2 replicates, and every one holds their scatter, "
                                   "about 0.2")));

    answer_by(store, R"({"campaign": "m", )" + factors + R"("design": {"kind": "morris", "trajectories": 12}})",
              [](const Inputs& inputs) { return linear(inputs); });
    responses = ask("m");
    const auto morris = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(morris.method, study::Influence::Method::morris);
    ASSERT_TRUE(morris.factors[0].effects && morris.factors[1].effects);
    EXPECT_EQ(morris.used, 12);
    EXPECT_NEAR(morris.factors[0].effects->mu_star, 2, 1e-12);  // per unit of the range
    EXPECT_NEAR(morris.factors[1].effects->mu_star, 1, 1e-12);
    EXPECT_NEAR(morris.factors[1].effects->sigma, 0, 1e-12);
    EXPECT_THAT(morris.notes, Contains(HasSubstr("every mu* holds the scatter of runs, and no more of it than the "
                                                 "smallest, 1")));
}

TEST_F(Study, APointThatRepeatsCoordinatesOfItsBlockIsNotBinned) {
    // Eight of ten points of a block have one and the same x4: bins of all 320 would explain 0.3 of the variance.
    std::string factors;
    for (int j = 1; j <= 8; ++j)
        factors += (j > 1 ? ", " : "") + std::string(R"({"name": "x)") + std::to_string(j) + R"(", "between": [0, 1]})";
    answer_by(store,
              R"({"campaign": "s", "scene": "rehearsal", "factors": [)" + factors +
                  R"(], "design": {"kind": "saltelli", "base_points": 32}})",
              [](const Inputs& inputs) { return std::abs(input(inputs, "x1") - 0.5) + input(inputs, "x2"); });
    const auto responses = ask("s");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.used, 32);
    EXPECT_EQ(influence.split.points, 64);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("with 64 points in 4 bins")));
    for (std::size_t j = 2; j < 8; ++j) {
        const auto& factor = influence.factors[j];
        EXPECT_LT(factor.first.value, 0.15) << factor.factor;
        EXPECT_LT(factor.first.value, factor.first.half_width) << factor.factor;
        EXPECT_EQ(factor.trend, Trend::unknown) << factor.factor;
    }
}

TEST_F(Study, ALastBlockWithoutItsEndIsLeftOutAndCounted) {
    answer_by(store, R"({"campaign": "s", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}], "where": "x1 + x2 < 1.6",
        "design": {"kind": "saltelli", "base_points": 32}})",
              [](const Inputs& inputs) { return input(inputs, "x1") + 2 * input(inputs, "x2"); });
    const auto responses = ask("s");
    ASSERT_LT(responses.points.back(), responses.candidates - 1);
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.used + influence.excluded, 32);
}

TEST_F(Study, WithoutAnIndexNothingIsSaidOfItsFloor) {
    answer_by(store, halton("c", 2), [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    EXPECT_THAT(influence_of(responses, responses.observable("y")).notes,
                Not(Contains(HasSubstr("indistinguishable"))));
}

TEST_F(Study, ElementaryEffectsOfLevelsAreOnTheScaleOfTheRange) {
    // Linear in the place of a level: slope k - 1, whatever the numbers or words; trajectories that share cases count.
    answer_by(store, R"({"campaign": "m", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "levels": [0, 0.2, 0.4, 0.6, 0.8]}, {"name": "response", "levels": ["sum", "ishigami", "spreading_a"]}],
        "design": {"kind": "morris", "trajectories": 30}})",
              [](const Inputs& inputs) {
                  const auto& word = std::get<std::string>(inputs.at("response"));
                  const double place = word == "sum" ? 0 : word == "ishigami" ? 1 : 2;
                  return 3 * input(inputs, "x1") + 5 * input(inputs, "x2") + place;
              });
    const auto responses = ask("m");
    const auto influence = influence_of(responses, responses.observable("y"));
    const double slopes[] = {3, 4, 2};
    for (std::size_t j = 0; j < 3; ++j) {
        ASSERT_TRUE(influence.factors[j].effects);
        EXPECT_NEAR(influence.factors[j].effects->mu_star, slopes[j], 1e-9) << j;
        EXPECT_NEAR(influence.factors[j].effects->sigma, 0, 1e-9) << j;
        EXPECT_EQ(influence.factors[j].effects->count, 30) << j;
    }
}

TEST_F(Study, PlacesOfLevelsAreThoseOfTheCampaign) {
    // A condition leaves the levels 0.25 and 0.5 out: the others keep their places, 0, 3/4 and 1.
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "levels": [0, 0.25, 0.5, 0.75, 1]}], "where": "x2 < 0.1 or x2 > 0.6",
        "design": {"kind": "halton", "points": 64}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto responses = ask("c");
    EXPECT_EQ(responses.factors[1].seen.size(), 3U);
    for (std::size_t row = 0; row < responses.rows(); ++row) {
        const double level = responses.factors[1].values[row];
        EXPECT_DOUBLE_EQ(responses.factors[1].coordinate(row), level == 0 ? 0 : level == 1 ? 0.75 : 1);
    }
}

TEST_F(Study, BlocksThatShareTheirRunsGiveNoErrors) {
    // Six different cases, asked 1,024 and 120 times: mu* and total indices of six noisy runs.
    const auto campaign = [](const std::string& name, const std::string& design) {
        return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
            {"name": "x2", "levels": [0, 0.5, 1]}], "design": )" +
               design + "}";
    };
    std::uint64_t run = 0;
    const auto noise = [&](const Inputs&) { return disturbed(1, 0.5, 7, run++); };
    answer_by(store, campaign("total", R"({"kind": "saltelli", "base_points": 256})"), noise);
    answer_by(store, campaign("effects", R"({"kind": "morris", "trajectories": 40})"), noise);
    for (const auto* name : {"total", "effects"}) {
        const auto responses = ask(name);
        ASSERT_EQ(responses.rows(), 6U) << name;
        const auto influence = influence_of(responses, responses.observable("y"));
        EXPECT_THAT(influence.notes, testing::Contains(testing::HasSubstr("6 different cases: errors are unknown")));
        for (const auto& factor : influence.factors) {
            EXPECT_TRUE(std::isnan(factor.total.half_width));
            EXPECT_TRUE(std::isnan(factor.first_saltelli.half_width));
            if (factor.effects) {
                EXPECT_GT(factor.effects->mu_star, 0);
                EXPECT_TRUE(std::isnan(factor.effects->mu_star_half_width));
            }
        }
    }
}

TEST_F(Study, SensitivityTellsInteractionFromScatterWhereReplicatesAllow) {
    std::uint64_t count = 0;
    const auto response = [&](const Inputs& inputs) {  // V: 1/12 + 1/12 + 1/144 x 12 of interaction + 1/12 of scatter
        const double a = input(inputs, "x1") - 0.5, b = input(inputs, "x2") - 0.5;
        return disturbed(a - b + std::sqrt(12.0) * a * b, std::sqrt(1.0 / 12), 3, ++count);
    };
    const std::string text = R"({"campaign": "twice", "scene": "rehearsal", "replicates": 2,
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "halton", "sequences": 8, "points": 1200}})";
    answer_by(store, text, response);
    auto responses = ask("twice");
    auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_NEAR(influence.split.main_effects.value, 0.5, 2 * influence.split.main_effects.half_width);
    EXPECT_NEAR(influence.split.interactions.value, 0.25, 2 * influence.split.interactions.half_width);
    EXPECT_NEAR(influence.split.scatter.value, 0.25, 2 * influence.split.scatter.half_width);
    EXPECT_LT(influence.split.interactions.half_width, 0.06);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("pure error of 1200 degrees of freedom"));

    std::string once = text;
    once.replace(once.find("twice"), 5, "once");
    once.erase(once.find(R"("replicates": 2,)"), 16);
    answer_by(store, once, response);
    responses = ask("once");
    influence = influence_of(responses, responses.observable("y"));
    EXPECT_TRUE(std::isnan(influence.split.scatter.value));
    EXPECT_NEAR(influence.split.unexplained.value, 0.5, 2 * influence.split.unexplained.half_width);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("which replicates would tell apart"));
    const auto json = tests::parsed(to_json(responses, responses.observable("y"), influence));
    EXPECT_TRUE(json["variance"]["scatter"]["value"].is_null());
    EXPECT_GT(json["variance"]["unexplained"]["error"], 0);
}

TEST_F(Study, TrendsSayWhichWayTheResponseGoes) {
    const std::string text = R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}, {"name": "x4", "between": [0, 1]},
        {"name": "response", "levels": ["sum", "ishigami"]}], "design": {"kind": "halton", "sequences": 8, "points": 800}})";
    answer_by(store, text, [](const Inputs& inputs) {
        return input(inputs, "x1") - 2 * input(inputs, "x2") + 8 * std::pow(input(inputs, "x3") - 0.5, 2);
    });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    const auto trend = [&](std::size_t j) { return std::string(to_string(influence.factors[j].trend)); };
    EXPECT_EQ(trend(0), "rises");
    EXPECT_EQ(trend(1), "falls");
    EXPECT_EQ(trend(2), "bends");
    EXPECT_EQ(trend(3), "");
    EXPECT_EQ(trend(4), "");
    EXPECT_GT(influence.factors[0].rank_correlation.value, 0.2);
    EXPECT_LT(influence.factors[1].rank_correlation.value, -0.5);
    EXPECT_NEAR(influence.factors[2].rank_correlation.value, 0, 2 * influence.factors[2].rank_correlation.half_width);
    EXPECT_TRUE(std::isnan(influence.factors[4].rank_correlation.value));
    const auto table = influence_table(influence);
    EXPECT_THAT(table.columns, ElementsAre("factor", "first order", "trend", "rank correlation"));
}

// Listed points are no sample: whiskers come from replicates alone.
TEST_F(Study, AListedCampaignHasItsVarianceExplained) {
    std::string rows;
    for (int i = 0; i < 40; ++i)
        rows += (i == 0 ? "[" : ", [") + std::to_string(i % 8 / 8.0) + ", " + std::to_string(i / 40.0) + "]";
    answer_by(
        store,
        R"({"campaign": "c", "scene": "rehearsal", "replicates": 2, "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "list", "rows": [)" +
            rows + "]}}",
        [](const Inputs& inputs) { return input(inputs, "x1") - 3 * input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto influence = influence_of(responses, y);
    EXPECT_NEAR(influence.split.main_effects.value, 1, 1e-6);
    EXPECT_EQ(influence.split.pure.variance, 0);
    EXPECT_EQ(effect_errors(responses, y).source, study::EffectErrors::Source::pure_error);
}

// A weak straight effect under much scatter has binned means that go up and down: no bend.
TEST_F(Study, ScatterOfBinnedMeansIsNoBend) {
    std::uint64_t count = 0;
    const auto straight = [&](const Inputs& inputs) { return disturbed(0.5 * input(inputs, "x1"), 0.4, 21, ++count); };
    for (int k = 0; k < 10; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, halton(name, 640, R"(, "seed": )" + std::to_string(k + 1)), straight);
        const auto responses = ask(name);
        EXPECT_EQ(influence_of(responses, responses.observable("y")).factors[0].trend, study::Trend::rises) << name;
    }
}

TEST_F(Study, AReplicatedLatticeHasErrorsOfItsIndices) {
    std::uint64_t count = 0;
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "replicates": 4, "factors": [
        {"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}], "design": {"kind": "lattice", "levels": 6}})",
              [&](const Inputs& inputs) { return disturbed(input(inputs, "x1"), 0.2, 9, ++count); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    const double signal = 7.0 / 60;  // variance of six steps from 0 to 1
    const auto& x1 = influence.factors[0].first;
    const auto& x2 = influence.factors[1].first;
    EXPECT_NEAR(x1.value, signal / (signal + 0.04), 2 * x1.half_width);
    EXPECT_NEAR(x2.value, 0, 2 * x2.half_width);
    EXPECT_LT(x1.half_width, 0.1);
    EXPECT_LT(x2.half_width, 0.05);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("pure error, 108 degrees of freedom")));
    EXPECT_EQ(influence.factors[0].trend, study::Trend::rises);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("interactions indistinguishable from zero"));
}

// Cases of one corner have no value: the bins of x1 hold unlike shares of x2, which no scatter tells.
TEST_F(Study, ALatticeWithFailuresHasNoErrorsOfItsIndices) {
    int failed = 0;
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "replicates": 6, "factors": [
        {"name": "x1", "levels": [0, 0.5, 1]}, {"name": "x2", "levels": [0, 0.2, 1]}], "design": {"kind": "lattice"}})",
              [&](const Inputs& inputs) -> std::optional<double> {
                  if (input(inputs, "x1") > 0.9 && input(inputs, "x2") > 0.9 && failed < 5)
                      return ++failed, std::nullopt;
                  return input(inputs, "x1") + 10 * input(inputs, "x2");
              });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.excluded, 5);
    for (const auto& factor : influence.factors) EXPECT_TRUE(std::isnan(factor.first.half_width)) << factor.factor;
    EXPECT_THAT(influence.notes, Contains(HasSubstr("leave a lattice uneven")));
}

}  // namespace grainsweep::tests::report_influence_test
