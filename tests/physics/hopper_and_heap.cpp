// The scenes hopper and heap: closed forms, limits and the promises of a scene. Comparison with LIGGGHTS:
// tests/bench/scenes_slow.cpp.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::hopper_and_heap_test {

std::unique_ptr<Scene> make(const char* scene, const Inputs& changed, std::uint64_t seed = 1) {
    NoArtefacts none;
    const SceneInfo& info = *campaign::scene_named(scene);
    Inputs inputs = info.defaults();
    for (const auto& [name, value] : changed) inputs.at(name) = value;
    return info.make(inputs, seed, none);
}

Observations answer_of(const Scene& scene) {
    EXPECT_EQ(scene.health().reason, "");
    Observations seen;
    scene.observe(seen);
    return seen;
}

Observations run(const char* scene, const Inputs& changed, std::uint64_t seed = 1) {
    const auto one = make(scene, changed, seed);
    one->advance(1e9);
    EXPECT_TRUE(one->finished());
    return answer_of(*one);
}

void expect_slices_and_checkpoints_change_nothing(const char* scene, const Inputs& inputs) {
    const auto whole = make(scene, inputs);
    whole->advance(1e9);
    auto sliced = make(scene, inputs);
    double until = 0;
    for (int k = 0; !sliced->finished(); ++k) {
        sliced->advance(until += 0.0137);
        (void)answer_of(*sliced);
        if (k % 8 != 5) continue;
        Bytes state;
        sliced->save(state);
        sliced = make(scene, inputs);
        sliced->restore(state);
    }
    const auto a = answer_of(*whole), b = answer_of(*sliced);
    EXPECT_EQ(a.scalars, b.scalars);
    for (const auto& [name, samples] : a.series) {
        const auto& others = b.series.at(name);
        ASSERT_EQ(samples.size(), others.size()) << name;
        for (std::size_t k = 0; k < samples.size(); ++k) ASSERT_EQ(samples[k].value, others[k].value) << name << k;
    }
    EXPECT_EQ(whole->time(), sliced->time());
}

const Inputs small_hopper = {{"particles", std::int64_t{600}},
                             {"container_diameter", 0.05},
                             {"opening_size", 0.025},
                             {"settle_time", 0.25},
                             {"time_step", 8e-5}};

Inputs with(Inputs inputs, const Inputs& changed) {
    for (const auto& [name, value] : changed) inputs[name] = value;
    return inputs;
}

TEST(Hopper, NeitherSlicesNorCheckpointsChangeAnything) {
    for (const char* precision : {"mixed", "double"})
        expect_slices_and_checkpoints_change_nothing(
            "hopper", with(small_hopper, {{"precision", std::string(precision)}, {"stop_share", 0.3}}));
}

TEST(Hopper, WhatIsNotInsideIsOutside) {
    const auto scene = make("hopper", with(small_hopper, {{"size_distribution", std::string("uniform")}}));
    double whole = 0;
    for (const double d : scene->snapshot().scalars.at("diameter")) whole += 2500 * std::numbers::pi / 6 * d * d * d;
    while (!scene->finished()) {
        scene->advance(scene->time() + 0.1);
        const auto seen = answer_of(*scene);
        if (!seen.series.contains("mass_series")) continue;
        EXPECT_LE(seen.series.at("mass_series").back().value, whole * (1 + 1e-12));
    }
    const auto seen = answer_of(*scene);
    const auto& mass = seen.series.at("mass_series");
    EXPECT_EQ(mass.front().time, 0);
    EXPECT_EQ(mass.front().value, 0);
    for (std::size_t k = 1; k < mass.size(); ++k) EXPECT_GE(mass[k].value, mass[k - 1].value);
    EXPECT_NEAR(mass.back().value / whole, seen.scalars.at("discharged"), 1e-7) << "radii in single precision";
    // A flat floor keeps a ring of powder, and is not jammed by it.
    EXPECT_GT(seen.scalars.at("discharged"), 0.6);
    EXPECT_LT(seen.scalars.at("discharged"), 0.99);
    EXPECT_EQ(seen.scalars.at("jammed"), 0);
}

TEST(Hopper, AnOpeningOfTwoDiametersJamsAndAClosedOneHoldsAll) {
    int jams = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U})
        jams += run("hopper", with(small_hopper, {{"opening_size", 0.0105}}), seed).scalars.at("jammed") > 0 ? 1 : 0;
    EXPECT_GE(jams, 2);
    const auto closed = run("hopper", with(small_hopper, {{"opening_size", 0.004}}));
    EXPECT_EQ(closed.scalars.at("discharged"), 0);
    EXPECT_EQ(closed.scalars.at("jammed"), 1);
    EXPECT_FALSE(closed.scalars.contains("rate"));
    EXPECT_NEAR(closed.scalars.at("flow_time"), 10 * std::sqrt(0.004 / 9.81), 0.03) << "then it has ceased";
}

// Beverloo's law to a tenth; a steep smooth cone empties faster than a flat floor, and completely; a slot passes about
// its length times 1.03 rho phi sqrt(g) (w - k d)^(3/2) (Brown & Richards 1970).
TEST(Hopper, RatesFollowBeverloo) {
    const Inputs flat = {{"stop_share", 0.5}, {"particles", std::int64_t{2500}}};
    const auto round = run("hopper", flat).scalars;
    EXPECT_NEAR(round.at("rate") / round.at("beverloo_rate"), 0.9, 0.1) << "0.58 is for sand; spheres 0.51";
    EXPECT_LT(round.at("rate_error"), 0.06 * round.at("rate"));
    EXPECT_NEAR(round.at("bulk_fraction"), 0.58, 0.015);
    EXPECT_NEAR(round.at("rate_scaled"), round.at("rate") / (2500 * std::sqrt(9.81) * std::pow(0.005, 2.5)), 1e-9);
    EXPECT_GE(round.at("discharged"), 0.5);

    const auto cone = run("hopper", with(flat, {{"shape", std::string("conical")},
                                                {"half_angle", 15.0},
                                                {"wall_friction", 0.1},
                                                {"settle_time", 0.5},
                                                {"stop_share", 1.0}}))
                          .scalars;
    EXPECT_GT(cone.at("rate"), 1.15 * round.at("rate"));
    EXPECT_EQ(cone.at("discharged"), 1);

    const auto slot = run("hopper", with(flat, {{"opening", std::string("slot")}, {"opening_size", 0.025}})).scalars;
    const double brown =
        1.03 * 2500 * slot.at("bulk_fraction") * std::sqrt(9.81) * std::pow(0.025 - 1.4 * 0.005, 1.5) * 0.03;
    EXPECT_NEAR(slot.at("rate") / brown, 1, 0.2);
    EXPECT_FALSE(slot.contains("beverloo_rate"));
}

TEST(Heap, NeitherSlicesNorCheckpointsChangeAnything) {
    for (const char* floor : {"smooth", "rough"})
        expect_slices_and_checkpoints_change_nothing("heap", {{"particles", std::int64_t{200}},
                                                              {"tube_diameter", 0.03},
                                                              {"settle_time", 0.2},
                                                              {"end_time", 0.4},
                                                              {"time_step", 8e-5},
                                                              {"floor", std::string(floor)}});
}

// Rolling friction and a rough plate steepen a heap; without any friction there is none.
TEST(Heap, FrictionMakesIt) {
    const Inputs common = {{"particles", std::int64_t{700}}, {"tube_diameter", 0.05}, {"time_step", 8e-5}};
    const auto loose = run("heap", with(common, {{"rolling_friction", 0.05}})).scalars;
    const auto firm = run("heap", with(common, {{"rolling_friction", 0.3}})).scalars;
    const auto rough = run("heap", with(common, {{"rolling_friction", 0.05}, {"floor", std::string("rough")}})).scalars;
    for (const auto* one : {&loose, &firm, &rough}) {
        EXPECT_EQ(one->at("at_rest"), 1);
        EXPECT_EQ(one->at("particles"), 700) << "none rolled away";
        EXPECT_NEAR(one->at("angle"), one->at("angle_moment"), 6);
        EXPECT_GT(one->at("height"), 0.005);
    }
    EXPECT_GT(firm.at("angle_moment"), loose.at("angle_moment") + 5);
    EXPECT_GT(rough.at("angle_moment"), loose.at("angle_moment") + 2);
    EXPECT_LT(firm.at("run_out"), loose.at("run_out"));
    const auto none =
        run("heap", with(common, {{"friction", 0.0}, {"rolling_friction", 0.0}, {"end_time", 1.0}})).scalars;
    EXPECT_LT(none.contains("angle_moment") ? none.at("angle_moment") : 0, 3);
}

}  // namespace grainsweep::tests::hopper_and_heap_test
