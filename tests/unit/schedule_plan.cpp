#include "sweep/schedule/plan.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

using namespace grainsweep;
using namespace grainsweep::schedule;
using campaign::Outcome;

namespace {

std::vector<campaign::Case> questions(std::size_t n) {
    std::vector<campaign::Case> cases(n);
    for (std::size_t i = 0; i < n; ++i) cases[i].id = "case" + std::to_string(i);
    return cases;
}

Plan make_plan(std::size_t n, Rules rules = {}, std::vector<History> histories = {}, std::vector<double> predicted = {},
               std::vector<std::size_t> places = {}) {
    histories.resize(n);
    if (predicted.empty()) predicted.assign(n, 1.0);
    if (places.empty()) {
        places.resize(n);
        std::iota(places.begin(), places.end(), std::size_t{0});
    }
    return {questions(n), histories, predicted, places, rules};
}

TEST(Plan, HandsOutTheDesignInOrderAndIsOverWhenAllIsSettled) {
    Plan plan = make_plan(3);
    for (int i = 0; i < 3; ++i) {
        const auto start = plan.next();
        ASSERT_TRUE(start);
        EXPECT_EQ(start->question->id, "case" + std::to_string(i));
        EXPECT_EQ(start->attempt.number, 1);
        EXPECT_EQ(plan.ended(start->attempt, Outcome::completed), Plan::Verdict::settled);
    }
    EXPECT_FALSE(plan.next());
    EXPECT_TRUE(plan.over());
    EXPECT_EQ(plan.tally().settled_now, 3U);
}

TEST(Plan, LongCasesOfAWindowGoFirst) {
    Plan plan = make_plan(3, {}, {}, {1.0, 5.0, 2.0});
    EXPECT_EQ(plan.next()->question->id, "case1");
    EXPECT_EQ(plan.next()->question->id, "case2");
    EXPECT_EQ(plan.next()->question->id, "case0");
}

TEST(Plan, CountsWhatRunningCasesHaveDone) {
    Plan plan = make_plan(2, {.attempts = 3}, {}, {100.0, 10.0});
    const auto first = plan.next();
    plan.advanced(first->attempt, 0.1);  // from a checkpoint of an earlier run
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 100);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_done, 0);
    plan.advanced(first->attempt, 0.4);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 70);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_done, 30);
    plan.advanced(first->attempt, std::numeric_limits<double>::quiet_NaN());
    plan.advanced({"unknown", 1}, 0.5);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 70);
    EXPECT_EQ(plan.ended(first->attempt, Outcome::crashed), Plan::Verdict::again);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 110);
    const auto second = plan.next();
    plan.advanced(first->attempt, 0.9);  // a late word of the attempt that crashed
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 110);
    plan.advanced(second->attempt, 0.5);
    EXPECT_EQ(plan.ended(second->attempt, Outcome::completed), Plan::Verdict::settled);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_left, 10);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_done, 80);
}

TEST(Plan, TriesACrashAgainWithGrowingNumbersUpToTheLimit) {
    Plan plan = make_plan(1, {.attempts = 3});
    for (int number = 1; number <= 3; ++number) {
        const auto start = plan.next();
        ASSERT_TRUE(start);
        EXPECT_EQ(start->attempt.number, number);
        const auto verdict = plan.ended(start->attempt, number == 2 ? Outcome::timed_out : Outcome::crashed);
        EXPECT_EQ(verdict, number < 3 ? Plan::Verdict::again : Plan::Verdict::gave_up);
    }
    EXPECT_FALSE(plan.next());
    EXPECT_EQ(plan.tally().failed, 1U);
    EXPECT_EQ(plan.settled_prefix(), 1U);
}

TEST(Plan, GivenBackCasesCostNoTry) {
    Plan plan = make_plan(1, {.attempts = 1});
    for (int number = 1; number <= 5; ++number) {
        const auto start = plan.next();
        ASSERT_TRUE(start);
        EXPECT_EQ(start->attempt.number, number);
        plan.returned(start->attempt);
    }
    const auto start = plan.next();
    EXPECT_EQ(plan.ended(start->attempt, Outcome::completed), Plan::Verdict::settled);
}

TEST(Plan, ACaseNobodyBeganKeepsItsNumber) {
    Plan plan = make_plan(2);
    const auto first = plan.next()->attempt;
    plan.never_begun(first);
    plan.never_begun(first);  // said twice is said once
    EXPECT_EQ(plan.next()->attempt, first);
}

TEST(Plan, LateAnswersOfDeadAttemptsAreStale) {
    Plan plan = make_plan(1);
    const auto first = plan.next()->attempt;
    plan.returned(first);
    const auto second = plan.next()->attempt;
    EXPECT_EQ(plan.ended(first, Outcome::completed), Plan::Verdict::stale);
    EXPECT_EQ(plan.ended(second, Outcome::completed), Plan::Verdict::settled);
    EXPECT_EQ(plan.ended(second, Outcome::completed), Plan::Verdict::stale);
    EXPECT_EQ(plan.ended({"nobody", 1}, Outcome::completed), Plan::Verdict::stale);
}

TEST(Plan, ResumesWhereTheArchiveEnds) {
    Plan plan = make_plan(5, {.attempts = 2},
                          {{1, 0, Outcome::completed},
                           {1, 0, Outcome::unstable},
                           {2, 2, Outcome::crashed},      // exhausted
                           {1, 1, Outcome::crashed},      // one try left
                           {7, 0, Outcome::abandoned}});  // the boss died: always again
    EXPECT_EQ(plan.tally().decided, 3U);
    EXPECT_EQ(plan.settled_prefix(), 3U);
    const auto a = plan.next();
    EXPECT_EQ(a->question->id, "case3");
    EXPECT_EQ(a->attempt.number, 2);
    const auto b = plan.next();
    EXPECT_EQ(b->question->id, "case4");
    EXPECT_EQ(b->attempt.number, 8);
    EXPECT_FALSE(plan.next());
    EXPECT_EQ(plan.ended(a->attempt, Outcome::crashed), Plan::Verdict::gave_up);
}

TEST(Plan, AsksAgainWhatIsWantedAgain) {
    Plan plan = make_plan(3, {.attempts = 2, .again = Outcome::crashed},
                          {{1, 0, Outcome::completed}, {2, 2, Outcome::crashed}, {1, 0, Outcome::unstable}});
    const auto start = plan.next();
    EXPECT_EQ(start->question->id, "case1");
    EXPECT_EQ(start->attempt.number, 3);
    EXPECT_FALSE(plan.next());
}

TEST(Plan, LimitsOfThisRun) {
    Plan limited = make_plan(10, {.max_cases = 2});
    const auto a = limited.next();
    const auto b = limited.next();
    EXPECT_FALSE(limited.next());
    limited.ended(a->attempt, Outcome::completed);
    limited.ended(b->attempt, Outcome::completed);
    EXPECT_FALSE(limited.next());
    EXPECT_TRUE(limited.over());

    Plan fragile = make_plan(10, {.stop_after_failures = 1});
    fragile.ended(fragile.next()->attempt, Outcome::rejected);
    EXPECT_FALSE(fragile.next());
}

TEST(Plan, OneQuestionAtSeveralPlacesIsAskedOnce) {
    Plan plan = make_plan(2, {}, {}, {}, {0, 1, 0, 1});
    EXPECT_EQ(plan.settled_prefix(), 0U);
    plan.ended(plan.next()->attempt, Outcome::completed);
    EXPECT_EQ(plan.settled_prefix(), 1U);
    plan.ended(plan.next()->attempt, Outcome::completed);
    EXPECT_EQ(plan.settled_prefix(), 4U);
    EXPECT_FALSE(plan.next());
}

TEST(Plan, PrefixWaitsForGaps) {
    Plan plan = make_plan(3);
    const auto a = plan.next()->attempt;
    const auto b = plan.next()->attempt;
    plan.ended(b, Outcome::completed);
    EXPECT_EQ(plan.settled_prefix(), 0U);
    plan.ended(a, Outcome::completed);
    EXPECT_EQ(plan.settled_prefix(), 2U);
}

}  // namespace
