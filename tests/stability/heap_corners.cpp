// The heap over its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/scene_corners.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::heap_corners_test {

const SceneInfo& heap() {
    return *campaign::scene_named("heap");
}

TEST(HeapCorners, EveryBoundIsMadeOrRefused) {
    tests::expect_bounds_are_made_or_refused(heap());
}

TEST(HeapCorners, EveryExtremeIsAnsweredOrReported) {
    const std::string rough = "rough", in_double = "double";
    Inputs small = heap().defaults();
    small["particles"] = std::int64_t{150};
    small["tube_diameter"] = 0.03;
    small["settle_time"] = 0.1;
    small["end_time"] = 0.3;
    const std::vector<tests::Changes> table = {
        {},
        {{"precision", in_double}},
        {{"floor", rough}},
        {{"floor", rough}, {"precision", in_double}},
        {{"lift_speed", 1e-6}},
        {{"lift_speed", 5.0}},
        {{"lift_speed", 100.0}},
        {{"particles", std::int64_t{1}}},
        {{"particles", std::int64_t{1}}, {"floor", rough}},
        {{"settle_time", 0.0}},
        {{"end_time", 1e-6}},
        {{"friction", 0.0}, {"rolling_friction", 0.0}},
        {{"friction", 2.0}, {"rolling_friction", 1.0}},
        {{"friction", 0.0}, {"wall_friction", 2.0}},
        {{"wall_friction", 0.0}, {"wall_rolling_friction", 0.0}},
        {{"restitution", 1.0}},
        {{"restitution", 0.01}},
        {{"wall_restitution", 1.0}},
        {{"youngs_modulus", 1e5}},
        {{"youngs_modulus", 1e5}, {"gravity", 100.0}},
        {{"youngs_modulus", 1e8}, {"time_step", 1e-3}},
        {{"time_step_fraction", 1.0}},
        {{"gravity", 1e-3}},
        {{"cohesion", 1e5}},
        {{"cohesion", 1e6}, {"youngs_modulus", 1e5}},
        {{"size_distribution", std::string("lognormal")}, {"size_spread", 0.5}},
        {{"size_distribution", std::string("uniform")}, {"size_spread", 0.5}, {"floor", rough}},
        {{"diameter", 0.02}},
        {{"tube_diameter", 0.0151}},
        {{"tube_diameter", 10.0}},
        {{"tube_diameter", 10.0}, {"floor", rough}},
    };
    auto outcomes = tests::outcomes_of(heap(), small, table);
    EXPECT_GT(outcomes[campaign::Outcome::completed], 20);
    EXPECT_GE(outcomes[campaign::Outcome::unstable], 1);
    EXPECT_GE(outcomes[campaign::Outcome::rejected], 2);
}

}  // namespace grainsweep::tests::heap_corners_test
