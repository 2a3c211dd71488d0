// Steps, whole numbers, groups, shares and conditions of factors: how values follow, and what is one case.
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/simplex.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/designs/factor.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/when_clauses.hpp"
#include "tests/support/stored_both_ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace grainsweep::tests::campaign_factor_rules_test {

using namespace campaign;
using namespace designs;
using nlohmann::json;

json sound() {
    return json::parse(R"({"campaign": "trial", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]},
                    {"name": "x3", "between": [0, 1]}, {"name": "x4", "levels": [0, 0.5, 1]}],
        "design": {"kind": "halton", "points": 64}})");
}

Campaign read(const json& text) {
    auto campaign = parse_campaign(text.dump(), ".");
    campaign.space.when = store::when_clauses(campaign.space);
    return campaign;
}

Cases cases_of(const Campaign& campaign) {
    return unfold(campaign, store::make_filter(campaign.where, filter_names(campaign)));
}

double real(const Inputs& inputs, const char* name) {
    return std::get<double>(inputs.at(name));
}

std::size_t different(const Cases& cases) {
    std::set<CaseHash> hashes;
    for (std::size_t i = 0; i < cases.size(); ++i) hashes.insert(cases.hash(i));
    return hashes.size();
}

TEST(Step, MultiplesAreDecimalNumbers) {
    EXPECT_EQ(multiple_of(0.1, 3), 0.3);
    EXPECT_EQ(multiple_of(0.0005, 7), 0.0035);
    EXPECT_EQ(multiple_of(0.15, -3), -0.45);
    EXPECT_EQ(multiple_of(25, 4), 100);
    EXPECT_TRUE(is_multiple(0.1, 0.7));
    EXPECT_FALSE(is_multiple(0.1, 0.75));
    const auto inside = multiples_in(0.1, 0.3, 0.7);
    EXPECT_EQ(inside.first, 3);
    EXPECT_EQ(inside.last, 7);
    EXPECT_EQ(multiples_in(0.5, 0.6, 0.9).count(), 0);
}

TEST(Step, GivesEveryMultipleTheSameProbabilityAndKeepsTheRange) {
    // 0.5, 1, 1.5, 2 lie in [0.3, 2.2]: the ends have whole cells.
    std::map<double, int> counts;
    constexpr int points = 4000;
    for (int i = 0; i < points; ++i) ++counts[stepped({0.3, 2.2}, 0.5, (i + 0.5) / points)];
    EXPECT_EQ(counts, (std::map<double, int>{{0.5, 1000}, {1, 1000}, {1.5, 1000}, {2, 1000}}));
    EXPECT_EQ(stepped({0.3, 2.2}, 0.5, 0), 0.5);
    EXPECT_EQ(stepped({0.3, 2.2}, 0.5, 1), 2);
}

TEST(Step, OfALogarithmicRangeHasTheProbabilityOfItsCell) {
    std::map<double, int> counts;
    constexpr int points = 100'000;
    for (int i = 0; i < points; ++i) ++counts[stepped({1, 4, Scale::log}, 1, (i + 0.5) / points)];
    ASSERT_EQ(counts.size(), 4U);
    for (const auto& [x, count] : counts)
        EXPECT_NEAR(count, points * std::log((x + 0.5) / (x - 0.5)) / std::log(4.5 / 0.5), 1) << x;
}

TEST(Step, OfADistributionHasTheProbabilityOfItsCell) {
    const stats::Distribution normal(stats::Normal{10, 2});
    std::map<double, int> counts;
    constexpr int points = 100'000;
    for (int i = 0; i < points; ++i) ++counts[stepped(normal, 1, (i + 0.5) / points)];
    EXPECT_GE(counts.size(), 15U);
    for (const auto& [x, count] : counts) {
        EXPECT_EQ(x, std::round(x));
        EXPECT_NEAR(count, points * (normal.cumulative(x + 0.5) - normal.cumulative(x - 0.5)), 1) << x;
    }
    const stats::Distribution cut(stats::Normal{10, 2}, 8.2, 11.7);  // no value outside of its ends
    counts.clear();
    for (int i = 0; i < points; ++i) ++counts[stepped(cut, 1, (i + 0.5) / points)];
    ASSERT_EQ(counts.size(), 3U);
    EXPECT_NEAR(counts.at(9), points * cut.cumulative(9.5), 1);
    EXPECT_NEAR(counts.at(11), points * (1 - cut.cumulative(10.5)), 1);
}

TEST(Step, OfADistributionIsReadStoredAndRefused) {
    auto text = sound();
    text["factors"] = json::parse(R"([{"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}, "step": "5 %"},
                                      {"name": "x2", "triangular": {"low": 0, "mode": 0.5, "high": 1}}])");
    const auto campaign = read(text);
    EXPECT_EQ(campaign.space.factors[0].step, 0.05);
    const auto stated = factors_in(factors_line(campaign.space.factors));
    ASSERT_EQ(stated.size(), 2U);
    EXPECT_EQ(stated[0].step, 0.05);
    EXPECT_EQ(*stated[0].distribution(), stats::Distribution(stats::Normal{0.5, 0.1}, 0, 1));
    EXPECT_EQ(stated[1].step, std::nullopt);
    const auto cases = cases_of(campaign);
    for (std::size_t i = 0; i < cases.size(); ++i)
        EXPECT_TRUE(is_multiple(0.05, std::get<double>(cases.question(i).inputs.at("x1")))) << i;
    EXPECT_LT(different(cases), cases.size() + 1);
    text = json::parse(R"({"campaign": "c", "scene": "powder_spreading", "design": {"kind": "halton", "points": 4},
        "factors": [{"name": "time_step_fraction", "lognormal": {"median": 0.1, "ratio": 2}, "step": 0.2}]})");
    try {
        (void)read(text);
        FAIL() << "a fraction of 0";
    } catch (const InputError& wrong) {
        EXPECT_THAT(wrong.what(), testing::HasSubstr("values round to 0, where 'time_step_fraction' has no value"));
    }
}

TEST(Step, MakesCasesOfOneValueOneCase) {
    auto text = sound();
    text["factors"] = json::parse(R"([{"name": "x1", "between": ["0 %", "100 %"], "step": "25 %"},
                                      {"name": "x2", "levels": [0, 1]}])");
    const auto campaign = read(text);
    EXPECT_EQ(campaign.space.factors[0].step, 0.25);
    const auto cases = cases_of(campaign);
    EXPECT_EQ(cases.size(), 64U);
    EXPECT_EQ(different(cases), 10U);
    // The same case as by levels.
    text["factors"][0] = json::parse(R"({"name": "x1", "levels": [0, 0.25, 0.5, 0.75, 1]})");
    const auto by_levels = cases_of(read(text));
    for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(cases.id(i), by_levels.id(i)) << i;
}

TEST(Step, OfAWholeNumberIsWhole) {
    auto text = json::parse(R"({"campaign": "trial", "scene": "rotating_drum",
        "factors": [{"name": "particles", "between": [100, 104], "whole": true}],
        "design": {"kind": "lattice", "levels": [5]}})");
    const auto cases = cases_of(read(text));
    for (std::size_t i = 0; i < cases.size(); ++i)
        EXPECT_EQ(std::get<std::int64_t>(cases.question(i).inputs.at("particles")), 100 + std::int64_t(i));
    text["factors"][0] = json::parse(R"({"name": "particles", "between": [95, 320], "step": 100})");
    text["design"]["levels"] = {3};
    EXPECT_EQ(std::get<std::int64_t>(cases_of(read(text)).question(2).inputs.at("particles")), 300);
}

TEST(Simplex, SharesAreUniformAndAddToOne) {
    // Of three uniform shares each has the density 2 (1 - x): mean 1/3, P(x > 1/2) = 1/4, and cov = -1/36 to var 1/18.
    constexpr std::size_t side = 200;
    const std::vector<double> low = {0, 0, 0};
    double mean = 0, above = 0, second = 0, product = 0;
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t k = 0; k < side; ++k) {
            const std::vector<double> u = {(double(i) + 0.5) / side, (double(k) + 0.5) / side, 0.7};
            const auto x = shares_at(u, low);
            ASSERT_TRUE(add_to_one(x));
            mean += x[2] / (side * side);
            above += (x[1] > 0.5 ? 1.0 : 0.0) / (side * side);
            second += x[1] * x[1] / (side * side);
            product += x[0] * x[2] / (side * side);
        }
    EXPECT_NEAR(mean, 1.0 / 3, 1e-4);
    EXPECT_NEAR(above, 0.25, 2e-3);
    EXPECT_NEAR(second - 1.0 / 9, 1.0 / 18, 1e-4);
    EXPECT_NEAR(product - 1.0 / 9, -1.0 / 36, 1e-4);
    EXPECT_EQ(shares_at(std::vector{1.0, 0.3, 0.0}, low), (std::vector<double>{1, 0, 0}));
}

TEST(Simplex, HoldsForEveryDesignThatFillsSpaceAndKeepsLowerEnds) {
    for (const char* design :
         {R"({"kind": "halton", "points": 40, "sequences": 4})", R"({"kind": "sobol", "points": 32})",
          R"({"kind": "random", "points": 40})", R"({"kind": "latin_hypercube", "points": 40})",
          R"({"kind": "saltelli", "base_points": 6})", R"({"kind": "morris", "trajectories": 6})"}) {
        auto text = sound();
        text["factors"] = json::parse(R"([{"name": "x4", "between": [0, 1]}, {"name": "x1", "between": [0.1, 1]},
            {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": ["20 %", "80 %"]}])");
        text["factors"][3]["between"][1] = "90 %";
        text["simplex"] = {"x3", "x1", "x2"};
        text["design"] = json::parse(design);
        const auto cases = cases_of(read(text));
        std::set<double> seen;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const auto inputs = cases.question(i).inputs;
            const std::vector shares = {real(inputs, "x1"), real(inputs, "x2"), real(inputs, "x3")};
            EXPECT_TRUE(add_to_one(shares)) << design << i;
            EXPECT_GE(shares[0], 0.1);
            EXPECT_GE(shares[1], 0);
            EXPECT_GE(shares[2], 0.2);
            seen.insert(shares[1]);
        }
        EXPECT_GT(seen.size(), 5U) << design;
    }
}

TEST(When, PutsTheDefaultWhereItDoesNotHold) {
    auto text = sound();
    text["factors"] = json::parse(R"([{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "between": [0.2, 1], "when": "x1 = 1"}, {"name": "x3", "between": [0.2, 1], "when": "x2 > 0.6"}])");
    const auto campaign = read(text);
    const auto cases = cases_of(campaign);
    const double standard = std::get<double>(default_of(campaign.scene(), "x2"));
    std::size_t at_default = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto inputs = cases.question(i).inputs;
        EXPECT_EQ(make_case(campaign.scene(), inputs, cases.question(i).seed).id, cases.id(i));
        if (real(inputs, "x1") == 0) {
            EXPECT_EQ(real(inputs, "x2"), standard);
        }
        if (real(inputs, "x2") <= 0.6) {
            EXPECT_EQ(real(inputs, "x3"), std::get<double>(default_of(campaign.scene(), "x3")));
        } else {
            EXPECT_GE(real(inputs, "x3"), 0.2);
        }
        at_default += real(inputs, "x1") == 0 ? 1 : 0;
        EXPECT_EQ(campaign.space.at(std::vector<double>{0, 0.9, 0.9}).at("x3"), Value{standard});
    }
    EXPECT_EQ(at_default, 32U);
    EXPECT_EQ(different(cases), 33U);
}

TEST(When, OfUncompiledConditionsIsAnError) {
    auto text = sound();
    text["factors"][0]["when"] = "x4 = 1";
    const auto campaign = parse_campaign(text.dump(), ".");
    EXPECT_THROW((void)unfold(campaign, {}), std::logic_error);
}

TEST(FactorRules, StandInTheIdentityAndComeBackFromIt) {
    auto text = sound();
    text["factors"] = json::parse(R"([{"name": "x1", "between": [0, 1], "step": 0.1, "group": "shape"},
        {"name": "x2", "between": [0, 1], "group": "shape"}, {"name": "x4", "levels": [0, 0.5, 1]},
        {"name": "x3", "between": [1, 8], "scale": "log", "whole": true, "when": "x4 = 1\n and x1 > 0.5"},
        {"name": "x5", "between": [0, 1]}, {"name": "x6", "between": [0.5, 1]}])");
    text["factors"][3]["between"] = {0.001, 1};
    text["factors"][3].erase("whole");
    text["simplex"] = {"x5", "x6"};
    text["design"] = {{"kind", "saltelli"}, {"base_points", 4}};
    const auto campaign = read(text);
    const auto identity = identity_of(campaign);
    EXPECT_EQ(texts_of(identity).factors,
              "x1 between 0 1 linear step 0.1\nx2 between 0 1 linear\nx4 levels 0 | 0.5 | 1\nx3 between 0.001 1 log\n"
              "x5 between 0 0.5 linear share\nx6 between 0.5 1 linear share\n"
              " group x1 shape\n group x2 shape\n when x3 x4 = 1  and x1 > 0.5\n");
    const auto asked = stored_both_ways(identity).factors;
    EXPECT_EQ(asked, campaign.space.factors);
    EXPECT_EQ(groups_of(asked), (std::vector<std::size_t>{0, 0, 1, 2, 3, 3}));
    EXPECT_EQ(group_names(asked), (std::vector<std::string>{"shape", "x4", "x3", "simplex"}));
    EXPECT_EQ(request_of(identity).group_count(), 4U);
    EXPECT_EQ(candidates_of(campaign), 4 * 6);
    text["factors"][0]["step"] = 0.2;
    EXPECT_THROW(require_same(identity, identity_of(read(text)), "a.db"), InputError);
}

TEST(FactorRules, GoTogetherWithDistributions) {
    auto text = sound();
    text["factors"] = json::parse(R"([{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "normal": {"mean": 0.5, "sd": 0.1}, "when": "x1 = 1"},
        {"name": "x3", "uniform": {"low": 0, "high": 1}, "step": 0.25}])");
    text["design"]["scramble"] = "random";
    const auto campaign = read(text);
    const auto identity = identity_of(campaign);
    EXPECT_EQ(stored_both_ways(identity).factors, campaign.space.factors);
    const auto cases = cases_of(campaign);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto inputs = cases.question(i).inputs;
        EXPECT_EQ(inputs.at("x2") == default_of(campaign.scene(), "x2"), real(inputs, "x1") == 0);
        EXPECT_TRUE(is_multiple(0.25, real(inputs, "x3")));
    }
}

TEST(FactorRules, WithoutThemIdentityAndDesignStay) {
    const auto campaign = read(sound());
    EXPECT_EQ(texts_of(identity_of(campaign)).factors,
              "x1 between 0 1 linear\nx2 between 0 1 linear\nx3 between 0 1 linear\nx4 levels 0 | 0.5 | 1\n");
    EXPECT_FALSE(repeats_weigh(campaign.space.factors));
}

TEST(FactorRules, AnotherOrderOfFactorsIsTheSameCampaign) {
    auto text = sound();
    text["factors"][0]["group"] = text["factors"][3]["group"] = "one";
    text["design"] = {{"kind", "morris"}, {"trajectories", 8}};
    auto campaign = read(text);
    const auto cases = cases_of(campaign);
    std::swap(text["factors"][0], text["factors"][2]);
    auto swapped = read(text);
    const std::vector<std::string> order = {"x1", "x2", "x3", "x4"};
    ASSERT_TRUE(reorder_factors(swapped, order));
    require_same(identity_of(campaign), identity_of(swapped), "a.db");
    const auto again = cases_of(swapped);
    ASSERT_EQ(again.size(), cases.size());
    EXPECT_EQ(cases.size(), 8U * 4U);
    for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(again.id(i), cases.id(i));
}

}  // namespace grainsweep::tests::campaign_factor_rules_test
