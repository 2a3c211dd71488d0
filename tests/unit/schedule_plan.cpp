#include "sweep/schedule/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::tests::schedule_plan_test {

using namespace schedule;
using campaign::Outcome;

campaign::Case question(std::uint32_t i) {
    campaign::Case made;
    made.id = "case" + std::to_string(i);
    return made;
}

Plan make_plan(std::size_t n, Rules rules = {}, std::vector<History> histories = {}, std::vector<double> predicted = {},
               std::vector<std::uint32_t> places = {}) {
    histories.resize(n);
    if (predicted.empty()) predicted.assign(n, 1.0);
    return {{question, histories, predicted, places, {}}, rules};
}

TEST(Plan, HandsOutTheDesignInOrderAndIsOverWhenAllIsSettled) {
    Plan plan = make_plan(3);
    for (int i = 0; i < 3; ++i) {
        const auto start = plan.next();
        ASSERT_TRUE(start);
        EXPECT_EQ(start->question.id, "case" + std::to_string(i));
        EXPECT_EQ(start->attempt.number, 1);
        EXPECT_EQ(plan.ended(start->attempt, Outcome::completed), Plan::Verdict::settled);
    }
    EXPECT_FALSE(plan.next());
    EXPECT_TRUE(plan.over());
    EXPECT_EQ(plan.tally().settled_now, 3U);
}

TEST(Plan, LongCasesGoFirstAtTheEnd) {
    Plan plan = make_plan(3, {}, {}, {1.0, 5.0, 2.0});
    EXPECT_EQ(plan.next()->question.id, "case1");
    EXPECT_EQ(plan.next()->question.id, "case2");
    EXPECT_EQ(plan.next()->question.id, "case0");
}

/// Workers that take as long as predicted: what the plan makes of it.
struct Course {
    double seconds = 0;                ///< until the last case ended
    std::vector<std::size_t> settled;  ///< prefix after each case
};

Course computed(Plan plan, std::size_t workers) {
    struct Running {
        double until;
        campaign::Attempt attempt;
        bool operator>(const Running& other) const { return until > other.until; }
    };
    std::priority_queue<Running, std::vector<Running>, std::greater<>> running;
    Course course;
    while (true) {
        while (running.size() < workers) {
            const auto start = plan.next();
            if (!start) break;
            running.push({course.seconds + start->predicted_seconds, start->attempt});
        }
        if (running.empty()) return course;
        course.seconds = running.top().until;
        plan.ended(running.top().attempt, Outcome::completed);
        running.pop();
        course.settled.push_back(plan.settled_prefix());
    }
}

/// Costs of a sweep over the diameter: a few cases cost thirty times the cheapest.
std::vector<double> uneven_costs(std::size_t n) {
    std::vector<double> costs(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double u = std::fmod(0.618033988749895 * static_cast<double>(i + 1), 1.0);
        costs[i] = std::pow(1 + 2 * u, 3);
    }
    return costs;
}

Plan uneven_plan(std::size_t n, std::size_t workers, std::optional<std::int64_t> max_cases = {},
                 std::vector<std::uint32_t> blocks = {}) {
    const Rules rules{.max_cases = max_cases, .workers = workers};
    return {{question, std::vector<History>(n), uneven_costs(n), {}, std::move(blocks)}, rules};
}

// What is finished is a usable beginning of the design, however early one looks.
TEST(Plan, TheSettledPrefixGrowsWithTheFinishedCases) {
    const auto course = computed(uneven_plan(2400, 2), 2);
    for (std::size_t finished = 1; finished <= 2200; ++finished)
        ASSERT_GE(course.settled[finished - 1] + 30, finished) << "a long case holds back what ran beside it";
    EXPECT_EQ(course.settled.back(), 2400U);
    const auto part = computed(uneven_plan(2400, 2, 24), 2);
    EXPECT_EQ(part.settled.size(), 24U);
    EXPECT_EQ(part.settled.back(), 24U) << "a limited run computes the beginning of the design";
}

TEST(Plan, TheEndKeepsAllWorkersBusy) {
    for (const std::size_t workers : {2, 8, 32}) {
        const auto costs = uneven_costs(2400);
        const double perfect = std::accumulate(costs.begin(), costs.end(), 0.0) / static_cast<double>(workers);
        const double shortest = *std::ranges::min_element(costs);
        EXPECT_LT(computed(uneven_plan(2400, workers), workers).seconds, perfect + 2 * shortest) << workers;
    }
}

// Where a campaign may stop after a block, a case of a later block would only delay the verdict.
TEST(Plan, NoCaseIsBroughtForwardOutOfALaterBlock) {
    std::vector<std::uint32_t> blocks;
    for (std::uint32_t i = 0; i < 64; ++i) blocks.push_back(i / 8);
    Plan plan = uneven_plan(64, 2, {}, blocks);
    for (std::int64_t i = 0; i < 64; ++i) {
        const auto start = plan.next();
        ASSERT_TRUE(start);
        EXPECT_EQ(std::stoll(start->attempt.case_id.substr(4)) / 8, i / 8);
    }
}

// A run that asks for a part of a stored design: the rest counts where it is finished, and is never computed.
TEST(Plan, ACaseThatIsNotAskedHoldsThePrefixAndIsNotHandedOut) {
    Plan plan = make_plan(4, {}, {{}, {1, 0, Outcome::completed, false}, {}, {0, 0, {}, false}});
    EXPECT_EQ(plan.tally().questions, 2U);
    plan.ended(plan.next()->attempt, Outcome::completed);
    EXPECT_EQ(plan.settled_prefix(), 2U);
    plan.ended(plan.next()->attempt, Outcome::completed);
    EXPECT_FALSE(plan.next());
    EXPECT_EQ(plan.settled_prefix(), 3U);
    EXPECT_EQ(plan.tally().decided, plan.tally().questions);
}

TEST(Plan, SumsThePredictionsOfWhatItMayStillStart) {
    Plan plan = make_plan(2, {.attempts = 3}, {{1, 0, {}, true}, {}}, {100.0, 10.0});
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 110);
    const auto first = plan.next();
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 10);
    EXPECT_DOUBLE_EQ(plan.predicted(first->attempt), 100);
    EXPECT_DOUBLE_EQ(plan.predicted({"unknown", 1}), 0);
    plan.advanced(first->attempt, 0.4);
    plan.advanced(first->attempt, std::numeric_limits<double>::quiet_NaN());
    plan.advanced({"unknown", 1}, 0.5);
    EXPECT_DOUBLE_EQ(plan.seconds_left(first->attempt), 60);
    EXPECT_EQ(plan.ended(first->attempt, Outcome::crashed), Plan::Verdict::again);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 110);
    const auto second = plan.next();
    plan.advanced(first->attempt, 0.9);  // a late word of the attempt that crashed
    EXPECT_DOUBLE_EQ(plan.seconds_left(second->attempt), 100);
    EXPECT_EQ(plan.ended(second->attempt, Outcome::completed), Plan::Verdict::settled);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 10);
    plan.leave_out_longer_than(5);
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 0);
}

TEST(Plan, PredictsOnlyWhatThisRunMaySettle) {
    const Plan plan = make_plan(4, {.max_cases = 2}, {}, {1.0, 2.0, 30.0, 40.0});
    EXPECT_DOUBLE_EQ(plan.tally().predicted_waiting, 3);
    EXPECT_EQ(plan.last_predicted(2), (std::vector<double>{2, 1}));  // long ones first, near the end
    EXPECT_FALSE(plan.last_predicted(1));
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
        EXPECT_EQ(plan.given_back(start->attempt), Plan::Verdict::again);
    }
    const auto start = plan.next();
    EXPECT_EQ(plan.ended(start->attempt, Outcome::completed), Plan::Verdict::settled);
}

TEST(Plan, ACaseThatOnlyComesBackIsGivenUpOneThatGetsFurtherIsNot) {
    Plan plan = make_plan(1, {.attempts = 1, .give_backs = 3});
    const auto share_of = [](int number) { return number <= 6 ? 0.1 * number : 0.6; };
    for (int number = 1; number <= 8; ++number) {
        const auto start = plan.next();
        ASSERT_TRUE(start) << number;
        plan.advanced(start->attempt, share_of(number));
        EXPECT_EQ(plan.given_back(start->attempt), number < 8 ? Plan::Verdict::again : Plan::Verdict::gave_up)
            << number;
    }
    EXPECT_FALSE(plan.next());
    EXPECT_EQ(plan.tally().failed, 1U);
    EXPECT_EQ(plan.settled_prefix(), 1U);
}

TEST(Plan, CountsWhatCouldBeStartedNow) {
    Plan plan = make_plan(5, {.max_cases = 3});
    EXPECT_EQ(plan.waiting(), 3U);
    const auto first = plan.next()->attempt;
    EXPECT_EQ(plan.waiting(), 2U);
    plan.given_back(first);
    EXPECT_EQ(plan.waiting(), 3U);
    plan.close();
    EXPECT_EQ(plan.waiting(), 0U);
    EXPECT_EQ(make_plan(5).waiting(), 5U);
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
    plan.given_back(first);
    const auto second = plan.next()->attempt;
    EXPECT_EQ(plan.ended(first, Outcome::completed), Plan::Verdict::stale);
    EXPECT_EQ(plan.ended(second, Outcome::completed), Plan::Verdict::settled);
    EXPECT_EQ(plan.ended(second, Outcome::completed), Plan::Verdict::stale);
    EXPECT_EQ(plan.ended({"unknown", 1}, Outcome::completed), Plan::Verdict::stale);
}

TEST(Plan, ResumesWhereTheArchiveEnds) {
    Plan plan = make_plan(5, {.attempts = 2},
                          {{1, 0, Outcome::completed},
                           {1, 0, Outcome::unstable},
                           {2, 2, Outcome::crashed},      // exhausted
                           {1, 1, Outcome::crashed},      // one try left
                           {7, 0, Outcome::abandoned}});  // the main program died: always again
    EXPECT_EQ(plan.tally().decided, 3U);
    EXPECT_EQ(plan.settled_prefix(), 3U);
    const auto a = plan.next();
    EXPECT_EQ(a->question.id, "case3");
    EXPECT_EQ(a->attempt.number, 2);
    const auto b = plan.next();
    EXPECT_EQ(b->question.id, "case4");
    EXPECT_EQ(b->attempt.number, 8);
    EXPECT_FALSE(plan.next());
    EXPECT_EQ(plan.ended(a->attempt, Outcome::crashed), Plan::Verdict::gave_up);
}

TEST(Plan, AsksAgainWhatIsWantedAgain) {
    Plan plan = make_plan(3, {.attempts = 2, .again = Outcome::crashed},
                          {{1, 0, Outcome::completed}, {2, 2, Outcome::crashed}, {1, 0, Outcome::unstable}});
    const auto start = plan.next();
    EXPECT_EQ(start->question.id, "case1");
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

/// Ends the next case with an outcome and a reason.
void end_next(Plan& plan, Outcome outcome, std::string_view reason) {
    const auto start = plan.next();
    ASSERT_TRUE(start);
    (void)plan.ended(start->attempt, outcome, reason);
}

TEST(Plan, StopsWhereTheFirstCasesFailAlike) {
    const Rules rules{.attempts = 1, .stop_after_alike = 3};
    Plan alike = make_plan(10, rules);
    for (const char* reason :
         {"exit code 3; it wrote: at 0.5\nno module a1", "exit code 3; it wrote: at 1e-3\nno module b2"})
        end_next(alike, Outcome::crashed, reason);
    EXPECT_FALSE(alike.failed_alike());
    end_next(alike, Outcome::crashed, "exit code 3; it wrote: at -7\nno module 0");
    EXPECT_TRUE(alike.failed_alike());
    EXPECT_FALSE(alike.next());
    EXPECT_EQ(alike.waiting(), 0U);
    EXPECT_EQ(alike.tally().failed_alike, "crashed: exit code 3; it wrote: at 0.5 ... no module a1");

    const auto goes_on = [&](const std::vector<std::pair<Outcome, std::string>>& ends) {
        Plan plan = make_plan(10, rules);
        for (const auto& [outcome, reason] : ends) end_next(plan, outcome, reason);
        return plan.next().has_value();
    };
    const auto crashed = Outcome::crashed;
    EXPECT_FALSE(goes_on({{crashed, "a"}, {crashed, "a"}, {crashed, "a"}}));
    EXPECT_TRUE(goes_on({{crashed, "a"}, {crashed, "b"}, {crashed, "a"}, {crashed, "a"}, {crashed, "a"}}));
    EXPECT_TRUE(goes_on({{crashed, "exit code 1"}, {crashed, "exit code 2"}, {crashed, "exit code 1"}}));
    EXPECT_TRUE(goes_on({{crashed, "a"}, {Outcome::rejected, "a"}, {crashed, "a"}}));
    EXPECT_TRUE(goes_on({{Outcome::completed, ""}, {crashed, "a"}, {crashed, "a"}, {crashed, "a"}}));
    EXPECT_TRUE(goes_on({{Outcome::skipped, ""}, {crashed, "a"}, {crashed, "a"}, {crashed, "a"}}));

    Plan resumed = make_plan(10, rules, {{1, 0, Outcome::completed}});
    for (int k = 0; k < 5; ++k) end_next(resumed, crashed, "a");
    EXPECT_TRUE(resumed.next()) << "an earlier case has an answer";
}

TEST(Plan, CasesOfARunThatFailedAlikeAreTriedAgain) {
    const Rules rules{.attempts = 2, .stop_after_alike = 3};
    const std::vector<History> failed = {{2, 2, Outcome::crashed}, {2, 2, Outcome::crashed}, {1, 0, Outcome::rejected}};
    Plan anew = make_plan(5, rules, failed);
    EXPECT_EQ(anew.tally().decided, 0U);
    EXPECT_EQ(anew.tried_again(), 3U);
    const auto first = anew.next();
    EXPECT_EQ(first->question.id, "case0");
    EXPECT_EQ(first->attempt.number, 3);
    EXPECT_EQ(anew.ended(first->attempt, Outcome::crashed, "a"), Plan::Verdict::again);

    Plan finished = make_plan(3, rules, failed);
    EXPECT_EQ(finished.tally().decided, 3U) << "nothing is left, so it had not stopped";
    EXPECT_EQ(make_plan(5, {.attempts = 2}, failed).tally().decided, 3U) << "--keep-going";
    auto with_answer = failed;
    with_answer.push_back({1, 0, Outcome::completed});
    EXPECT_EQ(make_plan(5, rules, with_answer).tally().decided, 4U);
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

}  // namespace grainsweep::tests::schedule_plan_test
