// The scene rotating_drum: balance of torques, what ends and gravity do, and the promises of a scene. Comparison with
// LIGGGHTS: tests/bench/scenes_slow.cpp.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::rotating_drum_test {

const SceneInfo& info() {
    return *campaign::scene_named("rotating_drum");
}

Inputs small_drum() {
    Inputs inputs = info().defaults();
    inputs["drum_diameter"] = 0.08;
    inputs["length"] = 0.02;
    inputs["rpm"] = 40.0;
    inputs["time_step"] = 8e-5;
    inputs["turning_time"] = 0.5;
    inputs["measured_time"] = 0.5;
    inputs["precision"] = std::string("double");
    return inputs;
}

std::unique_ptr<Scene> make(const Inputs& inputs, std::uint64_t seed = 1) {
    NoArtefacts none;
    return info().make(inputs, seed, none);
}

Observations answer_of(const Scene& scene) {
    EXPECT_EQ(scene.health().reason, "");
    Observations seen;
    scene.observe(seen);
    return seen;
}

Observations run(const Inputs& inputs, std::uint64_t seed = 1) {
    const auto scene = make(inputs, seed);
    scene->advance(1e9);
    EXPECT_TRUE(scene->finished());
    return answer_of(*scene);
}

void expect_same(const Observations& a, const Observations& b) {
    EXPECT_EQ(a.scalars, b.scalars);
    ASSERT_EQ(a.series.size(), b.series.size());
    for (const auto& [name, samples] : a.series) {
        const auto& others = b.series.at(name);
        ASSERT_EQ(samples.size(), others.size()) << name;
        for (std::size_t k = 0; k < samples.size(); ++k) ASSERT_EQ(samples[k].value, others[k].value) << name << k;
    }
}

// Angular momentum about the axis: torque of the walls = moment of the weights + dL/dt; over a time in which L hardly
// changes the drum's torque is the mean of sum m g (-x).
TEST(RotatingDrum, TheTorqueCarriesTheWeightOfTheBed) {
    for (const char* ends : {"periodic", "plates"}) {
        Inputs inputs = small_drum();
        inputs["ends"] = std::string(ends);
        const auto scene = make(inputs);
        scene->advance(0.5);
        const double start = scene->time();
        const auto momentum = [&] {
            double sum = 0;
            const auto seen = scene->snapshot();
            for (std::size_t i = 0; i < seen.positions.size(); ++i) {
                const auto& x = seen.positions[i];
                const auto& v = seen.vectors.at("velocity")[i];
                const double r = seen.scalars.at("diameter")[i] / 2;
                const double mass = 2500 * 4.0 / 3 * std::numbers::pi * r * r * r;
                sum += mass * (x[2] * v[0] - x[0] * v[2] + 0.4 * r * r * seen.vectors.at("angular_velocity")[i][1]);
            }
            return sum;
        };
        const double before = momentum();
        double moment = 0;
        int samples = 0;
        while (!scene->finished()) {
            scene->advance(scene->time() + 0.0025);
            const auto seen = scene->snapshot();
            for (std::size_t i = 0; i < seen.positions.size(); ++i) {
                const double r = seen.scalars.at("diameter")[i] / 2;
                moment -= 2500 * 4.0 / 3 * std::numbers::pi * r * r * r * 9.81 * seen.positions[i][0];
            }
            ++samples;
        }
        const double change = (momentum() - before) / (scene->time() - start);
        const auto seen = answer_of(*scene).scalars;
        EXPECT_NEAR(seen.at("torque") / (moment / samples + change), 1, 0.01) << ends;
        EXPECT_GT(seen.at("torque"), 0);
    }
}

TEST(RotatingDrum, NeitherSlicesNorCheckpointsNorObservingChangeAnything) {
    Inputs inputs = small_drum();
    inputs["ends"] = std::string("plates");
    inputs["measured_time"] = 0.2;
    const auto whole = make(inputs);
    whole->advance(1e9);
    auto sliced = make(inputs);
    double until = 0;
    for (int k = 0; !sliced->finished(); ++k) {
        sliced->advance(until += 0.0137);
        (void)answer_of(*sliced);
        if (k % 8 != 5) continue;
        Bytes state;
        sliced->save(state);
        sliced = make(inputs);
        sliced->restore(state);
    }
    expect_same(answer_of(*whole), answer_of(*sliced));
    EXPECT_EQ(whole->time(), sliced->time());
    auto other = small_drum();
    other["length"] = 0.021;
    Bytes state;
    whole->save(state);
    EXPECT_THROW(make(other)->restore(state), std::invalid_argument);
    EXPECT_NE(run(inputs, 2).scalars.at("angle_cm"), answer_of(*whole).scalars.at("angle_cm"));
}

// Plates with friction carry the powder up beside them: a short drum stands steeper (Dury, Ristow, Moss & Nakagawa
// 1998, Phys. Rev. E 57, 4491); without it they do nothing.
TEST(RotatingDrum, PlatesWithFrictionSteepenTheBed) {
    Inputs inputs = small_drum();
    const double without = run(inputs).scalars.at("angle_cm");
    inputs["ends"] = std::string("plates");
    const double held = run(inputs).scalars.at("angle_cm");
    inputs["end_friction"] = 0.0;
    inputs["wall_rolling_friction"] = -1.0;
    const double smooth = run(inputs).scalars.at("angle_cm");
    EXPECT_GT(held, without + 3);
    EXPECT_LT(std::abs(smooth - without), 0.5 * (held - without));
}

// A bed of a fill of 0.35 leaves its cells: the cover, the fill and the line through the surface belong together.
TEST(RotatingDrum, TheImageHoldsTheFill) {
    Inputs inputs = small_drum();
    inputs["occupancy_cell"] = 0.001;
    const auto seen = run(inputs);
    const double section = std::numbers::pi * 0.04 * 0.04;
    // 1644 or less: loose powder stands higher than at 0.58, its silhouette a little higher still.
    EXPECT_GT(seen.scalars.at("cover_area"), 0.35 * section);
    EXPECT_LT(seen.scalars.at("cover_area"), 0.5 * section);
    // One bed of a few hundred spheres scatters by two degrees, the mean of six by less than one.
    inputs["precision"] = std::string("mixed");
    double above_cover = 0, above_cm = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        const auto one = run(inputs, seed).scalars;
        above_cover += (one.at("angle_surface") - one.at("angle_cover")) / 6;
        above_cm += (one.at("angle_surface") - one.at("angle_cm")) / 6;
    }
    EXPECT_NEAR(above_cover, 0, 4);
    EXPECT_NEAR(above_cm, 0, 4);
    double cells = 0;
    for (const auto& cell : seen.series.at("occupancy")) {
        EXPECT_GE(cell.value, 0);
        EXPECT_LE(cell.value, 1);
        if (cell.value >= 0.5) cells += 1e-6;
        const double row = std::floor(cell.bin / 80), column = cell.bin - 80 * row;
        EXPECT_LE(std::hypot((column - 39.5) * 1e-3, (row - 39.5) * 1e-3), 0.04);
    }
    EXPECT_NEAR(cells, seen.scalars.at("cover_area"), 1e-12);
    const auto& surface = seen.series.at("surface");
    ASSERT_GT(surface.size(), 50U);
    for (std::size_t k = 1; k < surface.size(); ++k) EXPECT_GT(surface[k].bin, surface[k - 1].bin);
    EXPECT_GT(surface.front().value, surface.back().value) << "raised towards negative x";
    EXPECT_EQ(seen.series.at("angle_series").size(), 26U);
    EXPECT_NEAR(seen.series.at("angle_series").front().time, 0.5, 8e-5);
    EXPECT_NEAR(seen.series.at("angle_series").back().time, 1.0, 8e-5);
}

TEST(RotatingDrum, CountsFollowFromTheFill) {
    Inputs inputs = small_drum();
    inputs["turning_time"] = 0.0;
    inputs["measured_time"] = 0.02;
    // 0.35 of 0.58 of the drum's volume in spheres.
    const double wanted = 0.35 * 0.58 * std::numbers::pi * 0.04 * 0.04 * 0.02 / (std::numbers::pi / 6 * 1.25e-7);
    EXPECT_EQ(run(inputs).scalars.at("particles"), std::round(wanted));
    inputs["particles"] = std::int64_t{17};
    EXPECT_EQ(run(inputs).scalars.at("particles"), 17);
    inputs["particles"] = std::int64_t{700};
    EXPECT_THROW((void)make(inputs), std::invalid_argument) << "0.46 of the volume";
    inputs["particles"] = std::int64_t{0};
    inputs["end_friction"] = -0.5;
    EXPECT_THROW((void)make(inputs), std::invalid_argument);
}

TEST(RotatingDrum, APeriodOfTwoAndAHalfDiametersIsLongEnough) {
    auto inputs = small_drum();
    inputs["diameter"] = 0.0015;
    inputs["drum_diameter"] = 0.006;  // four, as narrow as drums may be
    inputs["length"] = 0.00375;
    EXPECT_NO_THROW(make(inputs));
    inputs["length"] = 0.00374;
    EXPECT_THROW(make(inputs), std::invalid_argument);
}

}  // namespace grainsweep::tests::rotating_drum_test
