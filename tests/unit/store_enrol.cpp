// Enrolling the same campaign is resuming, a longer one extends it, another one under its name is refused.
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/database.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace grainsweep::tests::store_enrol_test {

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
        } catch (const campaign::InputError& wrong) {
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
    other.space.scene = unowned(changed);
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

// A design of another size has other points under the same numbers: what is stored would leave the view.
TEST_F(StoreEnrol, ADesignThatDoesNotExtendKeepsItsSize) {
    auto campaign = small_campaign("lattice_campaign", 1);
    campaign.design = "lattice";
    campaign.request.options = {{"levels", std::int64_t{3}}, {"placement", std::string("endpoints")}};
    store.enrol(campaign, small_design(campaign, 3), here());
    campaign.request.options["levels"] = std::vector<std::int64_t>{3};
    EXPECT_EQ(refusal(campaign, small_design(campaign, 3)), "accepted") << "the same, written out";
    for (const std::int64_t levels : {2, 5}) {
        campaign.request.options["levels"] = levels;
        EXPECT_THAT(refusal(campaign, small_design(campaign, levels)),
                    AllOf(HasSubstr("$.design.levels: got " + std::to_string(levels)), HasSubstr("with 3"),
                          HasSubstr("a lattice of another size is another design"),
                          HasSubstr("give it a campaign name of its own")));
    }
    EXPECT_EQ(count("lattice_campaign"), "3");

    auto cube = small_campaign("cube");
    cube.design = "latin_hypercube";
    cube.request.options = {{"points", std::int64_t{8}}};
    store.enrol(cube, small_design(cube, 8), here());
    EXPECT_EQ(refusal(cube, small_design(cube, 8)), "accepted");
    cube.replicates = 2;
    EXPECT_EQ(refusal(cube, small_design(cube, 8)), "accepted") << "replicates are no size of the design";
    for (const std::int64_t points : {6, 12}) {
        cube.request.options["points"] = points;
        EXPECT_THAT(refusal(cube, small_design(cube, points)),
                    AllOf(HasSubstr("$.design.points: got " + std::to_string(points)), HasSubstr("with 8")));
    }
    EXPECT_EQ(count("cube"), "16");
}

// Less is a part of what is there: the run computes it, and the campaign stays as large as it was.
TEST_F(StoreEnrol, AskingForLessIsKeptBesideWhatIsStored) {
    auto campaign = small_campaign("c");
    campaign.replicates = 2;
    campaign.request.options["points"] = std::int64_t{12};
    store.enrol(campaign, small_design(campaign, 10), here());
    EXPECT_EQ(store.campaigns()[0].stored, (store::Extent{12, 2})) << "the last two points were filtered out";
    EXPECT_FALSE(store.campaigns()[0].shrunk());
    campaign.replicates = 1;
    campaign.request.options["points"] = std::int64_t{4};
    store.enrol(campaign, small_design(campaign, 4), here());
    const auto record = store.stored(campaign).value();
    EXPECT_EQ(record.stored, (store::Extent{12, 2}));
    EXPECT_EQ(record.asked, (store::Extent{4, 1}));
    EXPECT_TRUE(record.shrunk());
    EXPECT_EQ(count("c"), "20");
    EXPECT_EQ(only_cell(store, "SELECT design_extent FROM campaign"), "points = 12\n");
    EXPECT_EQ(store.placement("c").places.size(), 20U);
    const auto status = store.status();
    const auto cell = [&](const char* name) {
        const auto column = std::ranges::find(status.columns, name) - status.columns.begin();
        return text_of(status.rows[0][static_cast<std::size_t>(column)]);
    };
    EXPECT_EQ(cell("candidates"), "12");
    EXPECT_EQ(cell("dropped"), "2");
    EXPECT_EQ(cell("points"), "10");
    EXPECT_EQ(cell("finished"), "0");
    EXPECT_EQ(cell("asked_points"), "4");
    EXPECT_EQ(cell("asked_replicates"), "1");
}

// Written before extents were kept: what is placed is all that is known of them, also of a file that is only read.
TEST_F(StoreEnrol, AnArchiveWithoutExtentsIsReadAsItIsPlaced) {
    const auto campaign = small_campaign("c");
    store.enrol(campaign, small_design(campaign, 10), here());
    store = Store(folder / "other.db", Store::Mode::create);
    take_back_to_schema(2, file);
    store = Store(file, Store::Mode::read);
    EXPECT_EQ(store.campaigns()[0].stored, (store::Extent{10, 1}));
    EXPECT_FALSE(store.campaigns()[0].shrunk());
    EXPECT_EQ(store.status().rows.size(), 1U);
    store = Store(file, Store::Mode::create);
    EXPECT_EQ(store.campaigns()[0].stored, (store::Extent{10, 1})) << "migrated, and nothing known yet";
    auto less = campaign;
    less.request.options["points"] = std::int64_t{4};
    EXPECT_EQ(refusal(less, small_design(less, 4)), "accepted");
    EXPECT_EQ(store.campaigns()[0].stored, (store::Extent{10, 1}));
    EXPECT_EQ(store.campaigns()[0].asked, (store::Extent{4, 1}));
}

// Which option says how much is asked is the program's knowledge: an archive that sorted them otherwise is still read.
TEST_F(StoreEnrol, OptionsAreComparedWhereverTheArchiveKeepsThem) {
    auto campaign = small_campaign("c", 1);
    campaign.design = "morris";
    campaign.request.options = {{"grid", std::int64_t{4}}, {"trajectories", std::int64_t{2}}};
    store.enrol(campaign, small_design(campaign, 4), here());
    store = Store(folder / "other.db", Store::Mode::create);
    take_back_to_schema(4, file);
    store::Connection(file, store::Connection::Access::write)
        .execute(
            "UPDATE campaign SET design_options = '', design_extent = 'grid = 4' || char(10) || 'trajectories = 2'");
    store = Store(file, Store::Mode::create);
    EXPECT_EQ(refusal(campaign, small_design(campaign, 4)), "accepted");
    campaign.request.options["grid"] = std::int64_t{6};
    EXPECT_THAT(refusal(campaign, small_design(campaign, 4)), AllOf(HasSubstr("grid = 6"), HasSubstr("grid = 4")));
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

// New levels renumber the points; with fewer replicates some answers would have no place in the new design.
TEST_F(StoreEnrol, NothingLeavesTheViewWhenAFactorGainsLevels) {
    auto campaign = small_campaign("c", 1);
    campaign.design = "lattice";
    campaign.request.options = {{"placement", std::string("endpoints")}};
    campaign.replicates = 2;
    const auto lattice = [&](std::vector<double> values) {
        campaign.space.factors[0].range = campaign::Levels{{values.begin(), values.end()}};
        std::vector<campaign::PlacedCase> cases;
        for (std::size_t k = 0; k < values.size(); ++k) {
            Inputs inputs = campaign.scene().defaults();
            inputs["x1"] = values[k];
            for (std::int64_t r = 0; r < campaign.replicates; ++r)
                cases.push_back({question(campaign, inputs, r), static_cast<std::int64_t>(k), 0, r});
        }
        return cases;
    };
    store.enrol(campaign, lattice({0.0, 1.0}), here());
    campaign.replicates = 1;
    EXPECT_THAT(refusal(campaign, lattice({0.0, 0.25, 0.5, 0.75, 1.0})), HasSubstr("does not contain them all"));
    campaign.replicates = 2;
    EXPECT_EQ(refusal(campaign, lattice({0.0, 0.5, 1.0})), "accepted");
    EXPECT_EQ(count("c"), "6");
}

TEST_F(StoreEnrol, AListGrowsAtItsEnd) {
    auto campaign = small_campaign("c");
    campaign.design = "list";
    campaign.request.options = {{"rows", designs::Rows{}}};
    auto cases = small_design(campaign, 5);
    store.enrol(campaign, std::span<const campaign::PlacedCase>(cases).first(4), here());
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

TEST(CampaignName, AWordOfSqlIsRefused) {
    for (const char* name : {"select", "SELECT", "Order", "group", "table", "join", "values"}) {
        try {
            store::check_campaign_name(name);
            ADD_FAILURE() << name;
        } catch (const campaign::InputError& wrong) {
            EXPECT_THAT(wrong.what(), AllOf(HasSubstr("$.campaign"), HasSubstr("is a word of SQL")));
        }
    }
    for (const char* name : {"selection", "orders", "first", "plan", "key", "point", "mfr", "c"})
        EXPECT_NO_THROW(store::check_campaign_name(name));
}

TEST_F(StoreEnrol, WhatADeadMainProgramBeganIsAbandonedAndAnOldAnswerStands) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 3);
    store.enrol(campaign, cases, here());
    settle(store, cases[0].question, 1);
    settle(store, cases[1].question, 1);
    store.group([&] {
        store.begin({cases[1].question.id, 2});
        store.begin({cases[2].question.id, 1});
    });
    EXPECT_FALSE(store.enrol(campaign, cases, here())[2].outcome) << "this main program is alive";
    store = Store(folder / "other.db", Store::Mode::create);
    Store next(file, Store::Mode::create);
    const auto states = next.enrol(campaign, cases, here());
    EXPECT_EQ(states[0].outcome, Outcome::completed);
    EXPECT_EQ(states[1].outcome, Outcome::completed) << "asked again, and the old answer stands until there is a new";
    EXPECT_EQ(states[1].attempts, 2);
    EXPECT_EQ(next.attempts(cases[1].question.id).at(1).outcome, Outcome::abandoned);
    EXPECT_EQ(next.result(cases[1].question.id)->attempt.number, 1);
    EXPECT_EQ(next.values("c", "y")[1].value, answer(cases[1].question, 1).observations.scalars.at("y"));
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

}  // namespace grainsweep::tests::store_enrol_test
