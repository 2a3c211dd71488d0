#include "sweep/schedule/time_left.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace grainsweep::tests::schedule_time_left_test {
namespace {

using campaign::Attempt;
using schedule::TimeLeft;

TEST(TimeLeft, TakesPredictionsBeforeAnythingRan) {
    const auto seconds = TimeLeft().estimate(40, 2, 0);
    EXPECT_DOUBLE_EQ(seconds.done, 0);
    EXPECT_DOUBLE_EQ(seconds.to_go, 40);
}

TEST(TimeLeft, LearnsThePaceFromCasesThatEnded) {
    TimeLeft left;
    left.begun({"a", 1}, 10, 0);
    left.ended({"a", 1}, 5, 5);
    left.begun({"b", 1}, 2, 5);
    left.ended({"b", 1}, 1, 6);
    const auto seconds = left.estimate(100, 1, 6);
    EXPECT_DOUBLE_EQ(seconds.done, 6);
    EXPECT_DOUBLE_EQ(seconds.to_go, 50);
}

TEST(TimeLeft, FollowsARunningCaseByItsShare) {
    TimeLeft left;
    left.begun({"a", 1}, 10, 0);
    left.reported({"a", 1}, 0.5, 20);
    const auto seconds = left.estimate(10, 1, 20);
    EXPECT_DOUBLE_EQ(seconds.done, 20);
    EXPECT_DOUBLE_EQ(seconds.to_go, 20 + 40);  // its own half, and a case four times as long as predicted
}

TEST(TimeLeft, WhatACheckpointHeldWasNotComputedHere) {
    TimeLeft left;
    left.begun({"a", 2}, 10, 0);
    left.reported({"a", 2}, 0.8, 1);
    left.reported({"a", 2}, 0.9, 2);
    const auto seconds = left.estimate(0, 1, 2);
    EXPECT_DOUBLE_EQ(seconds.done, 1);
    EXPECT_NEAR(seconds.to_go, 1, 1e-12);
}

TEST(TimeLeft, CasesThatEndEarlyTeachWhereTheNextOnesEnd) {
    TimeLeft left;
    left.begun({"a", 1}, 10, 0);
    left.reported({"a", 1}, 0.2, 4);
    left.ended({"a", 1}, 5, 5);  // at a share of 0.25
    left.begun({"b", 1}, 10, 5);
    left.reported({"b", 1}, 0.2, 9);
    EXPECT_NEAR(left.estimate(0, 1, 9).to_go, 1, 1e-12);
}

TEST(TimeLeft, OfSilentCasesTheOldestRunOnEveryWorker) {
    TimeLeft left;
    left.begun({"z", 1}, 1, 0);
    left.ended({"z", 1}, 1, 1);
    for (const char* name : {"a", "b", "c"}) left.begun({name, 1}, 10, name[0] == 'c' ? 5 : 1);
    const auto seconds = left.estimate(0, 2, 7);
    EXPECT_DOUBLE_EQ(seconds.done, 1 + 6 + 6);
    EXPECT_DOUBLE_EQ(seconds.to_go, 4 + 4 + 10);
}

TEST(TimeLeft, NearTheEndWaitsForTheWorkerThatIsLast) {
    TimeLeft left;
    left.begun({"z", 1}, 4, 0);
    left.ended({"z", 1}, 4, 4);
    left.begun({"a", 1}, 4, 4);
    left.begun({"b", 1}, 4, 4);
    // Two seconds after, both have 2 s left, and a case of 4 s follows on one of two workers: 6 s, not 4.
    EXPECT_DOUBLE_EQ(left.estimate(4, 2, 6).to_go, 2 + 2 + 4);
    const auto seconds = left.estimate(4, 2, 6, std::vector<double>{4});
    EXPECT_DOUBLE_EQ(seconds.done, 8);
    EXPECT_DOUBLE_EQ(seconds.to_go / seconds.done * 6, 6);
}

TEST(TimeLeft, KnowsAttemptsApartAndForgetsWhatIsTakenBack) {
    TimeLeft left;
    left.begun({"a", 1}, 10, 0);
    left.taken_back("a");
    left.begun({"a", 2}, 10, 4);
    left.reported({"a", 1}, 0.9, 5);  // a late word of the attempt that crashed
    left.reported({"a", 2}, std::nan(""), 5);
    EXPECT_DOUBLE_EQ(left.estimate(0, 1, 6).to_go, 8);
    left.ended({"a", 1}, 5, 6);
    left.ended({"unknown", 1}, 5, 6);
    EXPECT_DOUBLE_EQ(left.estimate(0, 1, 6).done, 2);
}

/// The worst error of the time left, relative to it, after a tenth of a run of one worker and before its last
/// twentieth.
double worst_error(const std::vector<double>& taken, const std::vector<double>& predicted) {
    double whole = 0, waiting = 0;
    for (std::size_t k = 0; k < taken.size(); ++k) whole += taken[k], waiting += predicted[k];
    TimeLeft left;
    double now = 0, worst = 0;
    for (std::size_t k = 0; k < taken.size(); ++k) {
        const Attempt attempt{std::to_string(k), 1};
        left.begun(attempt, predicted[k], now);
        waiting -= predicted[k];
        constexpr int beats = 8;
        for (int beat = 1; beat < beats; ++beat) {
            const double at = now + taken[k] * beat / beats;
            left.reported(attempt, static_cast<double>(beat) / beats, at);
            const auto seconds = left.estimate(waiting, 1, at);
            if (at > 0.1 * whole && at < 0.95 * whole)
                worst = std::max(worst, std::abs(seconds.to_go * at / seconds.done / (whole - at) - 1));
        }
        now += taken[k];
        left.ended(attempt, taken[k], now);
    }
    return worst;
}

TEST(TimeLeft, IsWithinAThirdWherePredictionsAreWrongByAnyFactor) {
    std::vector<double> taken, predicted;
    for (int k = 0; k < 40; ++k) {
        predicted.push_back(1 + (k * 7) % 10);
        taken.push_back(predicted.back() * (k % 3 == 0 ? 2.4 : 1.8));
    }
    EXPECT_LT(worst_error(taken, predicted), 1.0 / 3);
}

}  // namespace
}  // namespace grainsweep::tests::schedule_time_left_test
