// Enrolling the same campaign is resuming, a longer one extends it, another one under its name is refused.
#include "sweep/campaign/wrong_question.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainsweep::tests {
namespace {

using campaign::Campaign;
using campaign::Outcome;
using store::Store;
using testing::HasSubstr;

struct StoreEnrol : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "a.db";
    Store store{file, Store::Mode::create};

    std::string refusal(const Campaign& campaign, const std::vector<campaign::PlacedCase>& cases) {
        const auto before = dump_of(store);
        try {
            store.enrol(campaign, cases, here());
        } catch (const campaign::WrongQuestion& wrong) {
            EXPECT_EQ(dump_of(store), before) << "a refused campaign leaves no trace";
            return wrong.what();
        }
        return "accepted";
    }
    std::string count(std::string_view table) { return only_cell(store, "SELECT count(*) FROM " + std::string(table)); }
};

TEST_F(StoreEnrol, TwiceIsOnce) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 10);
    store.enrol(campaign, cases, here());
    const auto before = dump_of(store);
    store.enrol(campaign, cases, here());
    EXPECT_EQ(dump_of(store), before);
    EXPECT_EQ(count("sim_case"), "10");
    EXPECT_EQ(count("case_input"), "20") << "two factors of eighteen inputs differ from their defaults";
}

TEST_F(StoreEnrol, MorePointsAndReplicatesExtend) {
    auto campaign = small_campaign("c");
    store.enrol(campaign, small_design(campaign, 10), here());
    const auto longer = small_design(campaign, 15);
    store.enrol(campaign, longer, here());
    EXPECT_EQ(count("c"), "15");
    campaign.replicates = 3;
    store.enrol(campaign, small_design(campaign, 15), here());
    EXPECT_EQ(count("c"), "45");
    EXPECT_EQ(store.campaigns()[0].replicates, 3);
    EXPECT_EQ(store.find_case(longer[12].question.id), longer[12].question);
}

TEST_F(StoreEnrol, FewerPointsAreAPartOfWhatIsThere) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 10);
    store.enrol(campaign, cases, here());
    settle(store, cases[2].question, 1);
    const auto states = store.enrol(campaign, small_design(campaign, 4), here());
    ASSERT_EQ(states.size(), 4u);
    EXPECT_EQ(states[2].outcome, Outcome::completed);
    EXPECT_EQ(count("c"), "10");
}

TEST_F(StoreEnrol, CampaignsShareTheCasesTheyBothAsk) {
    const auto first = small_campaign("first");
    const auto cases = small_design(first, 10);
    store.enrol(first, cases, here());
    settle(store, cases[5].question, 1);
    auto second = small_campaign("second");
    const auto states = store.enrol(second, small_design(second, 20), here());
    EXPECT_EQ(states[5].outcome, Outcome::completed);
    EXPECT_EQ(states[5].attempts, 1);
    EXPECT_EQ(count("sim_case"), "20");
    EXPECT_EQ(store.values("second", "y")[5].value, store.values("first", "y")[5].value);
}

TEST_F(StoreEnrol, AnotherQuestionUnderTheSameNameIsRefused) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 4);
    store.enrol(campaign, cases, here());

    auto other = campaign;
    other.space.factors[1].range = campaign::Between{0, 2, campaign::Scale::linear};
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("x2 between 0 2 linear"), HasSubstr("x2 between 0 1 linear"),
                                             HasSubstr("'c'"), HasSubstr("$.factors")));
    other = campaign;
    other.space.factors.pop_back();
    EXPECT_THAT(refusal(other, cases), HasSubstr("nothing"));
    other = campaign;
    std::swap(other.space.factors[0], other.space.factors[1]);
    EXPECT_THAT(refusal(other, cases), HasSubstr("x1"));
    other = campaign;
    other.space.fixed["noise"] = 0.5;
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("noise = 0.5"), HasSubstr("$.fixed")));
    other = campaign;
    other.seed = 0xffffffffffffffffULL;
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("18446744073709551615"), HasSubstr("seed 1")));
    other = campaign;
    other.where = "x1 > x2";
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("x1 > x2"), HasSubstr("no condition")));
    other = campaign;
    other.design = "sobol";
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("sobol"), HasSubstr("halton")));
    other = campaign;
    other.request.options["scramble"] = std::string("none");
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("scramble = none"), HasSubstr("scramble = random")));
    other = campaign;
    other.name = "C";
    EXPECT_THAT(refusal(other, cases), HasSubstr("name"));

    SceneInfo changed = campaign.scene();
    changed.revision = 2;
    other = campaign;
    other.space.scene = &changed;
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("revision 2"), HasSubstr("revision 1")));
    changed = campaign.scene();
    changed.name = "another";
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("another"), HasSubstr("rehearsal")));
    changed = campaign.scene();
    changed.parameters[0].default_value = 0.25;
    EXPECT_THAT(refusal(other, cases), AllOf(HasSubstr("default x1 = 0.25"), HasSubstr("needs a new revision")));
}

TEST_F(StoreEnrol, MorePointsOfTheSameDesignAreTheSameQuestion) {
    auto campaign = small_campaign("c");
    store.enrol(campaign, small_design(campaign, 4), here());
    campaign.request.options["points"] = std::int64_t{6};
    campaign.convergence = campaign::Convergence{.observable = "y", .rule = "any_change", .gates = {"mean"}};
    campaign.limits.wall_seconds = 5;
    EXPECT_EQ(refusal(campaign, small_design(campaign, 6)), "accepted");
    EXPECT_EQ(store.campaigns()[0].convergence, campaign.convergence);
}

// A lattice with more levels: the numbers of its points change, the answers stay.
TEST_F(StoreEnrol, AFinerLatticeReplacesThePlacesAndKeepsTheAnswers) {
    auto campaign = small_campaign("lattice_campaign", 1);
    campaign.design = "lattice";
    campaign.request.options = {{"levels", std::int64_t{3}}, {"placement", std::string("endpoints")}};
    const auto lattice = [&](int levels) {
        std::vector<campaign::PlacedCase> cases;
        for (int k = 0; k < levels; ++k) {
            Inputs inputs = campaign.scene().defaults();
            inputs["x1"] = static_cast<double>(k) / (levels - 1);
            cases.push_back({question(campaign, inputs, 0), k, 0, 0});
        }
        return cases;
    };
    store.enrol(campaign, lattice(3), here());
    settle(store, lattice(3)[2].question, 1);
    store.group([&] { store.stop("lattice_campaign", 3); });
    campaign.request.options["levels"] = std::int64_t{5};
    const auto states = store.enrol(campaign, lattice(5), here());
    EXPECT_EQ(states[4].outcome, Outcome::completed) << "x1 = 1 was asked before";
    EXPECT_EQ(count("lattice_campaign"), "5");
    EXPECT_FALSE(store.campaigns()[0].stopped_at) << "it stopped on other points";
    EXPECT_THAT(refusal(campaign, lattice(3)), HasSubstr("3 cases"));
}

TEST_F(StoreEnrol, ALatticeMayGainLevelsOfAFactorButLoseNone) {
    auto campaign = small_campaign("c");
    campaign.design = "lattice";
    campaign.request.options = {{"placement", std::string("endpoints")}};
    const auto levels = [&](std::vector<Value> values) {
        campaign.space.factors[0].range = campaign::Levels{std::move(values)};
    };
    levels({0.0, 1.0});
    store.enrol(campaign, small_design(campaign, 4), here());
    levels({0.0, 0.5, 1.0});
    EXPECT_EQ(refusal(campaign, small_design(campaign, 6)), "accepted");
    levels({0.0, 1.0});
    EXPECT_THAT(refusal(campaign, small_design(campaign, 4)), HasSubstr("x1 levels 0 | 1"));
    levels({0.0, 0.5, 0.7});
    EXPECT_THAT(refusal(campaign, small_design(campaign, 6)), HasSubstr("x1 levels 0 | 0.5 | 1"));
}

TEST_F(StoreEnrol, AListGrowsAtItsEnd) {
    auto campaign = small_campaign("c");
    campaign.design = "list";
    campaign.request.options = {{"rows", designs::Rows{}}};
    auto cases = small_design(campaign, 5);
    store.enrol(campaign, std::span(cases).first(4), here());
    EXPECT_EQ(refusal(campaign, cases), "accepted");
    std::swap(cases[1].question, cases[2].question);
    EXPECT_THAT(refusal(campaign, cases), AllOf(HasSubstr("another row 1"), HasSubstr("extended at its end")));
}

TEST_F(StoreEnrol, ATakenNameIsRefused) {
    for (const char* name :
         {"campaign", "SIM_CASE", "series", "Convergence_History", "inputs", "provenance", "sqlite_master"}) {
        const auto campaign = small_campaign(name);
        EXPECT_THAT(refusal(campaign, small_design(campaign, 2)), HasSubstr("$.campaign")) << name;
    }
}

TEST_F(StoreEnrol, WhatADeadBossBeganIsAbandoned) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 3);
    store.enrol(campaign, cases, here());
    settle(store, cases[0].question, 1);
    settle(store, cases[1].question, 1);
    store.group([&] {
        store.begin({cases[1].question.id, 2});
        store.begin({cases[2].question.id, 1});
    });
    EXPECT_FALSE(store.enrol(campaign, cases, here())[2].outcome) << "this boss is alive";
    store = Store(folder / "other.db", Store::Mode::create);
    Store next(file, Store::Mode::create);
    const auto states = next.enrol(campaign, cases, here());
    EXPECT_EQ(states[0].outcome, Outcome::completed);
    EXPECT_EQ(states[1].outcome, Outcome::abandoned);
    EXPECT_EQ(states[1].attempts, 2);
    EXPECT_EQ(states[2].outcome, Outcome::abandoned);
    EXPECT_EQ(states[2].failures, 0) << "not the case's fault";
    next.group([&] { EXPECT_FALSE(next.finish(answer(cases[2].question, 1))) << "a late answer is stale"; });
    settle(next, cases[1].question, 3);
    settle(next, cases[2].question, 2);
    EXPECT_EQ(only_cell(next, "SELECT count(*) FROM c WHERE outcome = 'completed' AND y IS NOT NULL"), "3");
}

TEST_F(StoreEnrol, AStopIsForgottenWhenTheRuleOrThePrefixChanges) {
    auto campaign = small_campaign("c");
    campaign.convergence = campaign::Convergence{.observable = "y"};
    const auto stopped = [&](std::int64_t points) {
        store.enrol(campaign, small_design(campaign, points), here());
        return store.campaigns()[0].stopped_at.has_value();
    };
    const auto stop = [&] { store.group([&] { store.stop("c", 4); }); };
    stopped(8);
    stop();
    EXPECT_TRUE(stopped(8));
    EXPECT_TRUE(stopped(12)) << "more points behind it";
    campaign.convergence->tolerance = 0.005;
    EXPECT_FALSE(stopped(12));
    stop();
    campaign.replicates = 2;
    EXPECT_FALSE(stopped(12));
    stop();
    campaign.convergence->stop = false;
    EXPECT_FALSE(stopped(12));
    stop();
    campaign.convergence.reset();
    EXPECT_FALSE(stopped(12));
}

}  // namespace
}  // namespace grainsweep::tests
