// What the loop begins when its time is limited: only what can finish, or go on later, in what is left.
#include "tests/support/scheduler_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace grainsweep::tests::schedule_walltime_test {

using SchedulerWalltime = SchedulerLoop;

/// A crew whose cases take what is predicted, and the time that is left of `whole` seconds.
class TimedCrew {
public:
    TimedCrew(std::vector<double> seconds, double whole, bool cases_go_on)
        : seconds_(std::move(seconds)), left_(whole), whole_(whole), cases_go_on_(cases_go_on) {}
    [[nodiscard]] ScriptedCrew crew(const std::vector<campaign::PlacedCase>& placed) {
        return ScriptedCrew([&](const auto& attempt) -> workers::PoolEvent {
            const auto at = std::ranges::find(placed, attempt.case_id, [](const auto& one) { return one.question.id; });
            const double takes = seconds_.at(static_cast<std::size_t>(at - placed.begin()));
            const double spent = std::min(takes, left_);
            left_ -= spent;
            if (spent < takes) return workers::GivenBack{attempt, "given back before it was finished", spent, true};
            return completed(attempt);
        });
    }
    [[nodiscard]] Walltime walltime() {
        return {[this] { return left_; }, whole_, cases_go_on_, 0.5};
    }

private:
    std::vector<double> seconds_;
    double left_, whole_;
    bool cases_go_on_;
};

TEST_F(SchedulerWalltime, NothingIsBegunThatCannotFinishInTime) {
    seconds = {1, 1, 1, 8, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 7, false);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_EQ(stored("completed"), 7) << "what fits is computed, what does not is left out";
    EXPECT_EQ(stored("abandoned"), 0);
    TimedCrew next(seconds, 10, false);
    auto again = next.crew(placed);
    EXPECT_EQ(run(again, {}, {}, nullptr, 1000, next.walltime()), Ending::finished);
}

TEST_F(SchedulerWalltime, WhatFitsIntoNoRunIsSaid) {
    seconds = {1, 1, 1, 12, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 10, false);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::too_long);
    EXPECT_EQ(stored("completed"), 9);
}

TEST_F(SchedulerWalltime, ACaseThatGoesOnLaterIsBegunWhereAPartOfItFits) {
    seconds = {1, 1, 1, 12, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 10, true);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_TRUE(crew.retired);
    EXPECT_EQ(store.attempts(placed[3].question.id).size(), 1U) << "it is given back unfinished";
}

TEST_F(SchedulerWalltime, NoPartIsBegunForLessThanItsSavingTakes) {
    seconds = std::vector<double>(10, 1);
    TimedCrew timed(seconds, 3.4, true);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_EQ(stored("completed"), 3);
    EXPECT_EQ(crew.started.size(), 3U);
}

}  // namespace grainsweep::tests::schedule_walltime_test
