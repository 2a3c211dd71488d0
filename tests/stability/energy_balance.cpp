// The check of the energy in cases of a few spheres, which bounce, roll and come to rest: sound steps are not called
// unstable, steps beyond the limit are. All 500 cases of each scene: tests/bench/few_spheres_slow.cpp.
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/few_spheres.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::energy_balance_test {

constexpr std::uint64_t cases = 24;  // of each scene
constexpr double sound_step = 0.2;   // the default

// Powder that jams under a tool is crushed, whatever the step.
TEST(EnergyBalance, FewSpheresAtASoundStepCreateNone) {
    for (const auto scene : tests::granular_scenes())
        for (std::uint64_t k = 0; k < cases; ++k) {
            const auto fate = tests::fate_of(scene, tests::few_spheres(scene, k, sound_step));
            if (fate.fault.find("contacts created") == std::string::npos) continue;
            const auto finer = tests::fate_of(scene, tests::few_spheres(scene, k, sound_step / 4));
            EXPECT_EQ(finer.fault.find("overlap"), 0U) << scene << " " << k << ": " << fate.fault;
        }
}

// One sphere on a floor, without loss, through many bounces: at their top nothing moves.
TEST(EnergyBalance, OneBouncingSphereIsSound) {
    for (const char* precision : {"mixed", "double"})
        for (const double restitution : {0.7, 0.9, 1.0}) {
            tests::FewSpheres one{campaign::scene_named("heap")->defaults(), 1, 0};
            one.inputs["particles"] = std::int64_t{1};
            one.inputs["restitution"] = restitution;
            one.inputs["settle_time"] = 3.0;
            one.inputs["precision"] = std::string(precision);
            EXPECT_EQ(tests::fate_of("heap", one).fault, "") << precision << " " << restitution;
        }
}

// Two to ten times the limit: reported, or nothing has come of it that the sound step has not.
TEST(EnergyBalance, StepsBeyondTheLimitAreFound) {
    int found = 0, tried = 0;
    for (const auto scene : tests::granular_scenes())
        for (std::uint64_t k = 0; k < cases; ++k) {
            const double step = 2 + 8 * static_cast<double>(k) / static_cast<double>(cases - 1);
            const auto coarse = tests::fate_of(scene, tests::few_spheres(scene, k, step));
            const bool by_step = coarse.refused.find("time_step: ") != std::string::npos;  // a machine knows its limit
            if (!coarse.refused.empty() && !by_step) continue;
            ++tried;
            found += coarse.fault.empty() && !by_step ? 0 : 1;
            if (!coarse.fault.empty() || by_step) continue;
            const auto sound = tests::fate_of(scene, tests::few_spheres(scene, k, sound_step));
            EXPECT_LE(coarse.most_kinetic, 1.5 * sound.most_kinetic) << scene << " " << k;
        }
    EXPECT_GT(found, 0.8 * tried);
}

}  // namespace grainsweep::tests::energy_balance_test
