// What is written comes back: cases, attempts, answers, costs; stale answers do not.
#include "sweep/campaign/input_error.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainsweep::tests::store_results_test {

using campaign::Outcome;
using store::Store;

struct StoreResults : testing::Test {
    Folder folder;
    campaign::Campaign asked = small_campaign("first");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 8);
    Store store{folder / "a.db", Store::Mode::create};
    std::vector<store::CaseState> states = store.enrol(asked, cases, here());
    const campaign::Case& one = cases[3].question;
};

TEST_F(StoreResults, NothingIsKnownOfNewCases) {
    ASSERT_EQ(states.size(), 8u);
    for (const auto& state : states) {
        EXPECT_EQ(state.attempts, 0);
        EXPECT_EQ(state.failures, 0);
        EXPECT_FALSE(state.outcome);
    }
    EXPECT_FALSE(store.result(one.id));
}

TEST_F(StoreResults, ACaseIsFoundCompleteByIdAndByPrefix) {
    const auto found = store.find_case(one.id.substr(0, 9));
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, one);
    EXPECT_EQ(store.find_case(one.id), one);
    EXPECT_FALSE(store.find_case("zz"));
    EXPECT_THROW((void)store.find_case(""), campaign::InputError);
}

TEST_F(StoreResults, ACurveIsReadAtAnyPlaceBetweenItsEnds) {
    auto given = answer(one, 1);
    const double none = std::nan("");
    given.observations.series["y_series"] = {{.time = 0.5, .bin = none, .value = 1},
                                             {.time = 1, .bin = none, .value = 3},
                                             {.time = 2, .bin = none, .value = none},
                                             {.time = 3, .bin = none, .value = 7}};
    auto other = answer(cases[4].question, 1);
    other.observations.series["y_series"] = {{.time = 0, .bin = 1, .value = 50},
                                             {.time = 0, .bin = 2, .value = 60},
                                             {.time = 9, .bin = 1, .value = 5},
                                             {.time = 9, .bin = 2, .value = 6}};
    store.group([&] {
        for (const auto* each : {&given, &other}) {
            store.begin(each->attempt);
            EXPECT_TRUE(store.finish(*each));
        }
    });
    const auto at = [&](double x, std::size_t point) {
        const auto values = store.values_along("first", "y_series", x);
        EXPECT_EQ(values.size(), cases.size());
        return values[point].value;
    };
    EXPECT_EQ(at(0.5, 3), 1);
    EXPECT_EQ(at(0.75, 3), 2);
    EXPECT_EQ(at(1, 3), 3);
    EXPECT_TRUE(std::isnan(at(1.5, 3))) << "beside a value that is not known";
    EXPECT_EQ(at(3, 3), 7);
    EXPECT_TRUE(std::isnan(at(0.4, 3))) << "before its begin";
    EXPECT_TRUE(std::isnan(at(3.1, 3)));
    EXPECT_EQ(at(1.5, 4), 5.5) << "a profile: its last time";
    EXPECT_TRUE(std::isnan(at(1, 5))) << "no answer yet";
    EXPECT_FALSE(store.values_along("first", "y_series", 1)[5].outcome);
    EXPECT_THROW((void)store.values_along("first", "y", 1), campaign::InputError) << "a scalar";
}

// A program writes the places of a curve in any order, some of them twice.
TEST_F(StoreResults, ACurveIsTheSameInWhateverOrderItsSamplesAreStored) {
    const double none = std::nan("");
    const std::vector<Sample> ascending = {{none, 0, 10}, {none, 1, 12}, {none, 1, 16}, {none, 2, 11}, {none, 4, 3}};
    const std::vector<std::vector<std::size_t>> orders = {{0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, {2, 4, 0, 3, 1}};
    store.group([&] {
        for (std::size_t k = 0; k < orders.size(); ++k) {
            auto given = answer(cases[k].question, 1);
            for (const auto i : orders[k]) given.observations.series["y_series"].push_back(ascending[i]);
            given.observations.series["y_series"].push_back({1, none, 99});  // of no bin
            store.begin(given.attempt);
            EXPECT_TRUE(store.finish(given));
        }
    });
    for (const auto& [at, value] :
         {std::pair(0.0, 10.0), {0.5, 12.0}, {1.0, 14.0}, {1.5, 12.5}, {3.0, 7.0}, {4.0, 3.0}})
        for (std::size_t k = 0; k < orders.size(); ++k)
            EXPECT_EQ(store.values_along("first", "y_series", at)[k].value, value) << at << ", order " << k;
    for (const double at : {-0.1, 4.1})
        for (std::size_t k = 0; k < orders.size(); ++k)
            EXPECT_TRUE(std::isnan(store.values_along("first", "y_series", at)[k].value));
    const auto extents = store.curve_extents("first", "y_series");
    ASSERT_EQ(extents.size(), orders.size());
    for (const auto& extent : extents) EXPECT_EQ(std::pair(extent.first, extent.last), std::pair(0.0, 4.0));
}

TEST_F(StoreResults, AnAnswerComesBackBitForBit) {
    auto given = answer(one, 1);
    given.observations.scalars = {{"y", 0.1 + 0.2}};
    given.observations.series["y_series"] = {{.time = 0.5, .bin = std::nan(""), .value = 1.0 / 3},
                                             {.time = 1, .bin = 2, .value = std::nan("")}};
    given.cost = {.wall_seconds = 1.5,
                  .cpu_seconds = 1.25,
                  .particle_steps = 3e9,
                  .phases = {{"contact", 0.75}, {"rebuild", 1e-7}},
                  .threads = 1.75};
    store.group([&] {
        store.begin(given.attempt);
        EXPECT_TRUE(store.finish(given));
    });
    const auto got = store.result(one.id);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->attempt, given.attempt);
    EXPECT_EQ(got->outcome, Outcome::completed);
    EXPECT_EQ(got->observations.scalars, given.observations.scalars);
    const auto& series = got->observations.series.at("y_series");
    ASSERT_EQ(series.size(), 2u);
    EXPECT_EQ(series[0].time, 0.5);
    EXPECT_TRUE(std::isnan(series[0].bin));
    EXPECT_EQ(series[0].value, 1.0 / 3);
    EXPECT_EQ(series[1].bin, 2);
    EXPECT_TRUE(std::isnan(series[1].value));
    EXPECT_EQ(got->cost.wall_seconds, 1.5);
    EXPECT_EQ(got->cost.cpu_seconds, 1.25);
    EXPECT_EQ(got->cost.particle_steps, 3e9);
    EXPECT_EQ(got->cost.phases, given.cost.phases);
    EXPECT_EQ(store.attempts(one.id).at(0).threads, 1.75);
}

TEST_F(StoreResults, ThreadsThatWereNotNotedAreNull) {
    store.group([&] {
        store.begin({one.id, 1});
        EXPECT_TRUE(store.finish(answer(one, 1)));
    });
    EXPECT_TRUE(std::isnan(store.attempts(one.id).at(0).threads));
    EXPECT_EQ(store.query("SELECT threads FROM attempt").rows.at(0).at(0), store::Table::Cell{});
}

TEST_F(StoreResults, AnUndefinedScalarIsNull) {
    auto given = answer(one, 1);
    given.observations.scalars["y"] = std::nan("");
    store.group([&] {
        store.begin(given.attempt);
        store.finish(given);
    });
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM first WHERE outcome = 'completed' AND y IS NULL"), "1");
    EXPECT_TRUE(std::isnan(store.values("first", "y")[3].value));
    EXPECT_EQ(store.values("first", "y")[3].outcome, Outcome::completed);
}

TEST_F(StoreResults, AnAnswerOfAnEarlierAttemptIsStale) {
    store.group([&] {
        store.begin({one.id, 1});
        store.begin({one.id, 2});
        EXPECT_FALSE(store.finish(answer(one, 1)));
        EXPECT_TRUE(store.finish(answer(one, 2)));
        EXPECT_FALSE(store.finish(answer(one, 2))) << "told twice";
    });
    EXPECT_EQ(store.attempts(one.id).size(), 2u);
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM observation"), "1");
}

TEST_F(StoreResults, AttemptNumbersOnlyGrow) {
    store.group([&] { store.begin({one.id, 2}); });
    store.group([&] { store.begin({one.id, 2}); });  // its worker died before it began
    EXPECT_THROW(store.group([&] { store.begin({one.id, 1}); }), std::logic_error);
    store.group([&] { store.finish(answer(one, 2)); });
    EXPECT_THROW(store.group([&] { store.begin({one.id, 2}); }), std::logic_error);
    EXPECT_EQ(store.attempts(one.id).size(), 1u);
    EXPECT_THROW(store.group([&] { store.begin({"no such case", 1}); }), std::logic_error);
}

TEST_F(StoreResults, ALaterAnswerReplacesTheEarlierOne) {
    settle(store, one, 1);
    auto later = answer(one, 2);
    later.outcome = Outcome::unstable;
    later.message = "overlap 0.3 d at (1, 2, 3), t = 0.5 s";
    later.observations.scalars.clear();
    store.group([&] {
        store.begin(later.attempt);
        store.finish(later);
    });
    EXPECT_EQ(store.result(one.id)->outcome, Outcome::unstable);
    EXPECT_EQ(store.result(one.id)->message, later.message);
    EXPECT_TRUE(store.result(one.id)->observations.scalars.empty());
    EXPECT_EQ(store.attempts(one.id)[0].outcome, Outcome::completed);
}

// `run --again completed`, and the second attempt brings nothing.
TEST_F(StoreResults, AnAttemptWithoutAnAnswerLeavesTheEarlierOneInPlace) {
    settle(store, one, 1);
    const auto before = dump_of(store);
    std::int64_t number = 1;
    for (const auto outcome : {Outcome::abandoned, Outcome::crashed, Outcome::timed_out}) {
        auto ended = answer(one, ++number);
        ended.outcome = outcome;
        ended.message = "no answer";
        ended.observations = {};
        ended.cost.wall_seconds = 7;
        store.group([&] { store.begin(ended.attempt); });
        EXPECT_EQ(dump_of(store), before) << "begun";
        store.group([&] { EXPECT_TRUE(store.finish(ended)); });
        EXPECT_EQ(dump_of(store), before) << to_string(outcome);
        EXPECT_EQ(store.result(one.id)->attempt.number, 1);
        EXPECT_EQ(store.result(one.id)->cost.wall_seconds, 0.25);
        EXPECT_EQ(store.attempts(one.id).back().outcome, outcome) << "the log has it";
    }
    const auto state = store.enrol(asked, cases, here())[3];
    EXPECT_EQ(state.outcome, Outcome::completed);
    EXPECT_EQ(state.failures, 2);
    auto later = answer(one, ++number);
    later.observations.scalars["y"] = 3;
    store.group([&] {
        store.begin(later.attempt);
        store.finish(later);
    });
    EXPECT_EQ(store.result(one.id)->observations.scalars.at("y"), 3);
    EXPECT_TRUE(store.verify().empty());
}

TEST_F(StoreResults, FailuresAreCounted) {
    auto failed = answer(one, 1);
    failed.outcome = Outcome::crashed;
    failed.message = "killed by signal 9";
    store.group([&] {
        store.begin(failed.attempt, {"0.1.0", "abc123", "feed", "avx2", "its processor", "its host"});
        store.finish(failed);
        failed.attempt.number = 2;
        failed.outcome = Outcome::timed_out;
        store.begin(failed.attempt, {"0.1.0", "abc123", "feed", "x86-64-v2", "another", "its host"});
        store.finish(failed);
        store.begin({one.id, 3});
    });
    const auto state = store.enrol(asked, cases, here())[3];
    EXPECT_EQ(state.attempts, 3);
    EXPECT_EQ(state.failures, 2);
    EXPECT_EQ(state.outcome, Outcome::timed_out);
    const auto log = store.attempts(one.id);
    ASSERT_EQ(log.size(), 3u);
    EXPECT_EQ(log[0].message, "killed by signal 9");
    EXPECT_EQ(log[0].computer, (campaign::Computer{"0.1.0", "abc123", "feed", "avx2", "its processor", "its host"}));
    EXPECT_EQ(log[1].computer.instruction_path, "x86-64-v2") << "on mixed machines it is not the run's";
    EXPECT_FALSE(log[2].outcome);
    EXPECT_EQ(log[2].started.size(), std::string("2026-01-31T12:00:00.000Z").size());
}

TEST_F(StoreResults, AGroupThatThrowsLeavesNothing) {
    const auto before = dump_of(store);
    EXPECT_THROW(store.group([&] {
        store.begin({one.id, 1});
        auto given = answer(one, 1);
        store.finish(given);
        throw std::runtime_error("lost");
    }),
                 std::runtime_error);
    EXPECT_EQ(dump_of(store), before);
    EXPECT_TRUE(store.attempts(one.id).empty());
    settle(store, one, 1);
    EXPECT_EQ(store.attempts(one.id).size(), 1u);
}

TEST_F(StoreResults, AnObservableThatTheSceneDoesNotDeclareIsRefused) {
    for (const bool scalar : {true, false}) {
        auto given = answer(one, 1);
        if (scalar) given.observations.scalars["undeclared"] = 2;
        if (!scalar) given.observations.series["undeclared"] = {{.time = 0, .value = 1}};
        EXPECT_THROW(store.group([&] {
            store.begin({one.id, 1});
            store.finish(given);
        }),
                     std::logic_error);
    }
    EXPECT_TRUE(store.attempts(one.id).empty());
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM observable WHERE name = 'undeclared'"), "0");
}

TEST_F(StoreResults, WritingOutsideAGroupIsAMistake) {
    EXPECT_THROW(store.begin({one.id, 1}), std::logic_error);
    EXPECT_THROW((void)store.finish(answer(one, 1)), std::logic_error);
    EXPECT_THROW(store.group([&] { store.group([] {}); }), std::logic_error);
}

TEST_F(StoreResults, ConvergenceComesBackWithItsHoles) {
    const double nan = std::nan("");
    const store::ConvergenceRow row{"y", 8, 1, 0, nan, nan, nan, 0.1, 0.2, nan, nan, nan, 0.5, 2, false};
    store.group([&] {
        store.record("first", row);
        auto later = row;
        later.points = 16;
        later.converged = true;
        store.record("first", later);
        store.stop("first", 16);
    });
    const auto history = store.convergence("first", "y");
    ASSERT_EQ(history.size(), 2u);
    EXPECT_EQ(history[0].mean_error, 0.1);
    EXPECT_TRUE(std::isnan(history[0].skewness));
    EXPECT_EQ(history[0].excluded, 2);
    EXPECT_TRUE(history[1].converged);
    EXPECT_EQ(store.campaigns().at(0).stopped_at, 16);
    EXPECT_EQ(
        only_cell(store, "SELECT count(*) FROM convergence_history WHERE campaign = 'first' AND kurtosis IS NULL"),
        "2");
    EXPECT_THROW(store.group([&] { store.record("fist", row); }), campaign::InputError);
}

TEST_F(StoreResults, ValuesStandInDesignOrder) {
    for (std::size_t k = cases.size(); k-- > 4;) settle(store, cases[k].question, 1);
    const auto values = store.values("first", "y");
    ASSERT_EQ(values.size(), 8u);
    for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_EQ(values[k].point, static_cast<std::int64_t>(k));
        EXPECT_EQ(values[k].sequence, static_cast<std::int64_t>(k % 2));
        EXPECT_EQ(values[k].outcome.has_value(), k >= 4);
        if (k >= 4) {
            EXPECT_EQ(values[k].value, answer(cases[k].question, 1).observations.scalars.at("y"));
        } else {
            EXPECT_TRUE(std::isnan(values[k].value));
        }
    }
    EXPECT_THROW((void)store.values("first", "z"), campaign::InputError);
    EXPECT_THROW((void)store.values("frist", "y"), campaign::InputError);
}

TEST_F(StoreResults, StatusCounts) {
    settle(store, cases[0].question, 1);
    settle(store, cases[1].question, 1);
    const auto table = store.status();
    ASSERT_EQ(table.rows.size(), 1u);
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < table.columns.size(); ++k) row[table.columns[k]] = text_of(table.rows[0][k]);
    EXPECT_EQ(row["campaign"], "first");
    EXPECT_EQ(row["scene"], "rehearsal");
    EXPECT_EQ(row["cases"], "8");
    EXPECT_EQ(row["completed"], "2");
    EXPECT_EQ(row["waiting"], "6");
    EXPECT_EQ(row["crashed"], "0");
    EXPECT_EQ(row["stopped_at"], "NULL");
}

}  // namespace grainsweep::tests::store_results_test
