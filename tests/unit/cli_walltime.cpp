#include "sweep/cli/walltime.hpp"

#include <gtest/gtest.h>

#include <ctime>
#include <string>

namespace grainsweep::tests::cli_walltime_test {

using namespace cli;

TEST(Walltime, IsTheEarlierOfWhatIsConfiguredAndTheJobsEnd) {
    EXPECT_FALSE(time_given({}, "", "", 1000));
    const auto configured = time_given(600, "", "", 1000);
    ASSERT_TRUE(configured);
    EXPECT_EQ(configured->left, 600);
    EXPECT_EQ(configured->whole, 600);
    const auto job = time_given({}, "4600", "1000", 3000);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->left, 1600);
    EXPECT_EQ(job->whole, 3600);
    EXPECT_EQ(time_given(600, "4600", "1000", 3000)->left, 600);
    const auto both = time_given(3000, "4600", "1000", 3000);
    EXPECT_EQ(both->left, 1600);
    EXPECT_EQ(both->whole, 3000);
}

TEST(Walltime, AJobWithoutAStartBeginsNow) {
    const auto job = time_given({}, "4600", "", 3000);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->left, 1600);
    EXPECT_EQ(job->whole, 1600);
}

TEST(Walltime, AJobThatIsOverLeavesNothing) {
    EXPECT_LE(time_given({}, "4600", "1000", 5000)->left, 0);
}

TEST(Walltime, WhatIsNoMomentIsNone) {
    for (const char* text : {"NONE", "Unknown", "0", "-5", "12x", " 12", "99999999999999999999999"})
        EXPECT_FALSE(time_given({}, text, "", 1000)) << text;
    constexpr double now = 1.7e9;
    for (const char* text : {"20261126", "2026-11-26", "12:00:00", "2026-13-01T00:00:00", "2026-11-26T12:00",
                             "2026-11-26T12:00:00Z", "2026-11-26T-1:00:00", "T::", "1999-11-26T12:00:00"})
        EXPECT_FALSE(time_given({}, text, "", now)) << text;
}

TEST(Walltime, TheEndMayBeADate) {
    std::tm local{};
    local.tm_year = 126;
    local.tm_mon = 10;
    local.tm_mday = 26;
    local.tm_hour = 12;
    local.tm_isdst = -1;
    const auto end = static_cast<double>(std::mktime(&local));
    for (const char* text : {"2026-11-26T12:00:00", "2026-11-26 12:00:00"}) {
        const auto given = time_given({}, text, "2026-11-26T11:00:00", end - 1000);
        ASSERT_TRUE(given) << text;
        EXPECT_EQ(given->left, 1000);
        EXPECT_EQ(given->whole, 3600);
    }
}

TEST(Walltime, AnEndThatIsNoneIsSaidToBe) {
    constexpr double now = 1.7e9;
    for (const char* text : {"", "0", "NONE", "Unknown", "N/A", "1700003600", "2023-11-15T12:00:00"})
        EXPECT_EQ(unreadable_end(text, now), "") << text;
    for (const char* text : {"20261126", "26.11.2026", "soon", "12x"})
        EXPECT_NE(unreadable_end(text, now).find(text), std::string::npos);
}

TEST(Walltime, ATenthIsKeptBackWithinBounds) {
    EXPECT_EQ(kept_back(86'400), 30);
    EXPECT_EQ(kept_back(120), 12);
    EXPECT_EQ(kept_back(20), 5);
    EXPECT_EQ(kept_back(4), 2);
}

}  // namespace grainsweep::tests::cli_walltime_test
