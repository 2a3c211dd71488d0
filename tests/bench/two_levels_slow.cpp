// How often the errors of campaigns with a tolerance hold, and their cost against the expensive setting alone: 200
// campaigns of each response, whose runs with one seed scatter independently, or mostly together.
#include "tests/support/two_settings.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace grainsweep::tests::two_levels_slow {

using stats::Statistic;

TEST(TwoLevelsSlow, StatedErrorsHoldOver200CampaignsOfEachResponse) {
    constexpr int campaigns = 200, least = 190;
    for (const auto& response : known_responses()) {
        if (response.name == "noise" || response.name == "waves") continue;  // sd of noise alone needs all points
        for (const double common : {0.0, 0.9}) {
            for (const bool with_sd : {false, true}) {
                std::vector<Statistic> gates = {Statistic::mean};
                if (with_sd) gates.push_back(Statistic::sd);
                const double tolerance = with_sd ? 0.03 : 0.01;
                const auto found = cover({response, common}, gates, tolerance, campaigns);
                const auto figures =
                    found.figures(response.name + (common > 0 ? " common" : "") + " at " + std::to_string(tolerance));
                std::cout << figures << std::endl;
                EXPECT_GE(found.mean_held, least - 4) << figures;
                EXPECT_GE(found.sd_held, with_sd ? least - 4 : 0) << figures;
                EXPECT_GE(found.within_goal, least) << figures;
            }
        }
    }
}

}  // namespace grainsweep::tests::two_levels_slow
