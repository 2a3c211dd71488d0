// The discharge scene with powder at rest that is not advanced (rest_speed); the plain path is the same cell without.
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/tpms_cells.hpp"

namespace grainsweep::tests::tpms_resting_test {

Inputs jammed_cell(double rest_speed) {
    Inputs inputs = campaign::scene_named("tpms_discharge")->defaults();
    inputs["edge"] = 10.0;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 98.1;
    inputs["cohesion"] = 50e3;
    inputs["end_time"] = 2.0;
    inputs["settle_rule"] = std::string("none");
    inputs["rest_speed"] = rest_speed;
    return inputs;
}

std::unique_ptr<Scene> make(const Inputs& inputs) {
    NoArtefacts none;
    return campaign::scene_named("tpms_discharge")->make(inputs, 1, none);
}

Observations answer_of(const Scene& scene) {
    Observations answer;
    scene.observe(answer);
    return answer;
}

/// Contacts seen from both sides, and the retention.
std::pair<double, double> end_of(const Inputs& inputs) {
    const auto scene = make(inputs);
    scene->advance(1e9);
    EXPECT_EQ(scene->health().reason, "");
    double contacts = 0;
    for (const double count : scene->snapshot().scalars.at("coordination")) contacts += count;
    return {contacts, answer_of(*scene).scalars.at("retention")};
}

TEST(TpmsResting, SlicesAndCheckpointsDoNotChangeTheAnswer) {
    const Inputs inputs = jammed_cell(1e-3);
    const auto whole = make(inputs);
    whole->advance(1e9);
    Bytes checkpoint;
    const auto scene = tests::run_in_slices([&] { return make(inputs); }, checkpoint);
    const Observations a = answer_of(*whole), b = answer_of(*scene);
    for (const char* name : {"retention", "peak_velocity", "max_overlap", "max_force"})
        EXPECT_EQ(a.scalars.at(name), b.scalars.at(name)) << name;
    for (const auto& [name, samples] : a.series) {
        const auto& others = b.series.at(name);
        ASSERT_EQ(samples.size(), others.size()) << name;
        for (std::size_t k = 0; k < samples.size(); ++k) EXPECT_EQ(samples[k].value, others[k].value) << name;
    }
}

TEST(TpmsResting, ContactsOfPowderAtRestAreReported) {
    const auto plain = end_of(jammed_cell(0)), resting = end_of(jammed_cell(1e-3));
    // Two realisations: a few of the 400 particles leave or stay by chance.
    EXPECT_GT(plain.second, 0.8);
    EXPECT_NEAR(resting.second, plain.second, 0.05);
    EXPECT_NEAR(resting.first, plain.first, 0.05 * plain.first);
}

TEST(TpmsResting, NotInACellThatVibrates) {
    Inputs inputs = jammed_cell(1e-3);
    inputs["vibration_amplitude"] = 1e-6;
    inputs["vibration_frequency"] = 100.0;
    EXPECT_THROW((void)make(inputs), std::invalid_argument);
}

}  // namespace grainsweep::tests::tpms_resting_test
