// The hopper over its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/scene_corners.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::hopper_corners_test {

const SceneInfo& hopper() {
    return *campaign::scene_named("hopper");
}

TEST(HopperCorners, EveryBoundIsMadeOrRefused) {
    tests::expect_bounds_are_made_or_refused(hopper());
}

TEST(HopperCorners, EveryExtremeIsAnsweredOrReported) {
    const std::string conical = "conical", slot = "slot", in_double = "double";
    Inputs small = hopper().defaults();
    small["particles"] = std::int64_t{250};
    small["container_diameter"] = 0.04;
    small["opening_size"] = 0.02;
    small["settle_time"] = 0.1;
    small["end_time"] = 0.2;
    const std::vector<tests::Changes> table = {
        {},
        {{"precision", in_double}},
        {{"shape", conical}, {"half_angle", 5.0}},
        {{"shape", conical}, {"half_angle", 85.0}},
        {{"shape", conical}, {"half_angle", 30.0}, {"precision", in_double}},
        {{"shape", conical}, {"opening_size", 1e-6}},
        {{"opening", slot}},
        {{"opening", slot}, {"precision", in_double}},
        {{"opening", slot}, {"slot_length", 0.0151}},
        {{"opening", slot}, {"slot_length", 0.01}},
        {{"opening", slot}, {"shape", conical}},
        {{"opening_size", 1e-6}},
        {{"opening_size", 0.0399}},
        {{"opening_size", 0.05}},
        {{"particles", std::int64_t{1}}},
        {{"settle_time", 0.0}},
        {{"stop_share", 1e-3}},
        {{"frame_interval", 1e-9}},
        {{"frame_interval", 1.0}},
        {{"friction", 0.0}},
        {{"friction", 2.0}, {"rolling_friction", 1.0}},
        {{"friction", 0.0}, {"wall_friction", 2.0}},
        {{"restitution", 1.0}},
        {{"restitution", 0.01}, {"wall_restitution", 1.0}},
        {{"youngs_modulus", 1e5}},
        {{"youngs_modulus", 1e5}, {"gravity", 100.0}},
        {{"youngs_modulus", 1e8}, {"time_step", 1e-3}},
        {{"time_step_fraction", 1.0}},
        {{"gravity", 1e-3}},
        {{"cohesion", 1e5}},
        {{"cohesion", 1e6}, {"youngs_modulus", 1e5}},
        {{"size_distribution", std::string("lognormal")}, {"size_spread", 0.5}},
        {{"size_distribution", std::string("uniform")}, {"size_spread", 0.5}},
        {{"diameter", 0.02}},
        {{"container_diameter", 0.0151}, {"opening_size", 0.01}},
        {{"container_diameter", 10.0}},
    };
    auto outcomes = tests::outcomes_of(hopper(), small, table);
    EXPECT_GT(outcomes[campaign::Outcome::completed], 22);
    EXPECT_GE(outcomes[campaign::Outcome::unstable], 1);
    EXPECT_GE(outcomes[campaign::Outcome::rejected], 5);
}

}  // namespace grainsweep::tests::hopper_corners_test
