#include "sweep/cli/walltime.hpp"

#include <gtest/gtest.h>

namespace grainsweep::cli {
namespace {

TEST(Walltime, IsTheEarlierOfWhatIsConfiguredAndTheJobsEnd) {
    EXPECT_FALSE(time_given(0, "", "", 1000));
    const auto configured = time_given(600, "", "", 1000);
    ASSERT_TRUE(configured);
    EXPECT_EQ(configured->left, 600);
    EXPECT_EQ(configured->whole, 600);
    const auto job = time_given(0, "4600", "1000", 3000);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->left, 1600);
    EXPECT_EQ(job->whole, 3600);
    EXPECT_EQ(time_given(600, "4600", "1000", 3000)->left, 600);
    const auto both = time_given(3000, "4600", "1000", 3000);
    EXPECT_EQ(both->left, 1600);
    EXPECT_EQ(both->whole, 3000);
}

TEST(Walltime, AJobWithoutAStartBeginsNow) {
    const auto job = time_given(0, "4600", "", 3000);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->left, 1600);
    EXPECT_EQ(job->whole, 1600);
}

TEST(Walltime, AJobThatIsOverLeavesNothing) {
    EXPECT_LE(time_given(0, "4600", "1000", 5000)->left, 0);
}

TEST(Walltime, WhatIsNoMomentIsNone) {
    for (const char* text : {"NONE", "Unknown", "0", "-5", "12x", " 12", "99999999999999999999999"})
        EXPECT_FALSE(time_given(0, text, "", 1000)) << text;
}

TEST(Walltime, ATenthIsKeptBackWithinBounds) {
    EXPECT_EQ(kept_back(86'400), 30);
    EXPECT_EQ(kept_back(120), 12);
    EXPECT_EQ(kept_back(20), 5);
    EXPECT_EQ(kept_back(4), 2);
}

}  // namespace
}  // namespace grainsweep::cli
