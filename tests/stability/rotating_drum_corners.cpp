// The drum over its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/scene_corners.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::rotating_drum_corners_test {

const SceneInfo& drum() {
    return *campaign::scene_named("rotating_drum");
}

Inputs small_case() {
    Inputs inputs = drum().defaults();
    inputs["drum_diameter"] = 0.06;
    inputs["length"] = 0.02;
    inputs["turning_time"] = 0.05;
    inputs["measured_time"] = 0.05;
    inputs["frame_interval"] = 0.01;
    inputs["precision"] = std::string("double");
    return inputs;
}

TEST(RotatingDrumCorners, EveryBoundIsMadeOrRefused) {
    tests::expect_bounds_are_made_or_refused(drum());
}

TEST(RotatingDrumCorners, EveryExtremeIsAnsweredOrReported) {
    const std::vector<tests::Changes> table = {
        {{"rpm", 1e-3}},
        {{"rpm", 600.0}},
        {{"rpm", 6000.0}},
        {{"friction", 0.0}, {"rolling_friction", 0.0}},
        {{"friction", 0.0}, {"wall_friction", 0.8}, {"rolling_friction", 0.0}},
        {{"friction", 2.0}, {"rolling_friction", 1.0}},
        {{"wall_friction", 0.0}},
        {{"wall_restitution", 0.01}},
        {{"restitution", 1.0}},
        {{"restitution", 0.01}},
        {{"youngs_modulus", 1e5}},
        {{"youngs_modulus", 1e5}, {"gravity", 100.0}},
        {{"youngs_modulus", 1e9}},
        {{"time_step", 5e-4}},
        {{"time_step", 1e-3}, {"youngs_modulus", 1e8}},
        {{"time_step_fraction", 1.0}},
        {{"gravity", 1e-3}},
        {{"fill", 0.6}},
        {{"fill", 1e-3}},
        {{"particles", std::int64_t{1}}},
        {{"ends", std::string("plates")}, {"length", 0.0051}},
        {{"ends", std::string("plates")}, {"end_friction", 2.0}, {"wall_friction", 0.0}},
        {{"length", 0.0149}},
        {{"length", 0.0151}},
        {{"size_distribution", std::string("lognormal")}, {"size_spread", 0.5}},
        {{"size_distribution", std::string("uniform")}, {"size_spread", 0.1}},
        {{"cohesion", 1e5}},
        {{"cohesion", 1e6}, {"youngs_modulus", 1e5}},
        {{"turning_time", 0.0}, {"measured_time", 0.01}},
        {{"frame_interval", 1e-7}},
        {{"frame_interval", 1.0}},
        {{"occupancy_cell", 1e-6}},
        {{"occupancy_cell", 1.0}},
        {{"diameter", 0.02}},
        {{"drum_diameter", 1e-4}},
    };
    auto outcomes = tests::outcomes_of(drum(), small_case(), table);
    EXPECT_GT(outcomes[campaign::Outcome::completed], 20);
    EXPECT_GE(outcomes[campaign::Outcome::unstable], 1);
    EXPECT_GE(outcomes[campaign::Outcome::rejected], 6);
}

}  // namespace grainsweep::tests::rotating_drum_corners_test
