// Do the intervals of response models hold? 200 synthetic campaigns, 40 points each; slow_response prints the counts.
#include "tests/support/synthetic_campaigns.hpp"

#include <gtest/gtest.h>

#include <cstdio>

using namespace grainsweep::tests;

TEST(ResponseModel, IntervalsHoldOver200Campaigns) {
    const auto counts = count_intervals(200);
    std::printf(
        "{\"campaigns\": 200, \"refused\": %d, \"asked\": %d, \"runs_in_50\": %d, \"runs_in_95\": %d, \"means_in_95\": "
        "%d}\n",
        counts.refused, counts.asked, counts.runs_50, counts.runs_95, counts.means_95);
    const double asked = counts.asked;
    // Refused: functions that vary less than their noise.
    // Points of one campaign are not independent: errors of the shares are those of 200 campaigns, not of 8,000 points.
    EXPECT_NEAR(counts.runs_50 / asked, 0.50, 0.06);
    EXPECT_NEAR(counts.runs_95 / asked, 0.95, 0.03);
    EXPECT_NEAR(counts.means_95 / asked, 0.95, 0.05);
}
