// What a worker refuses to compute.
#include "sweep/workers/compute.hpp"

#include "sweep/files/system_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <vector>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

namespace grainsweep::tests::workers_compute_test {

using testing::HasSubstr;
using testing::Not;

TEST(Compute, RejectsACaseWhoseFileHasChanged) {
    const auto file = std::filesystem::temp_directory_path() / "grainsweep_compute_packing.csv";
    const std::string contents = "x,y,z\n1,1,1\n";
    std::ofstream(file) << contents;
    const SceneInfo& info = *campaign::scene_named("tpms_discharge");
    campaign::Case question;
    question.scene = info.name;
    question.revision = info.revision;
    question.inputs = info.defaults();
    question.inputs["packing"] = "file:" + campaign::content_hash(contents) + ":" + file.string();
    NoArtefacts none;
    const auto answer = [&] {
        const auto found = workers::compute(question, 1, none, std::nullopt, [](const Scene&) { return true; }, {});
        EXPECT_EQ(found.value().outcome, campaign::Outcome::rejected);
        return found.value().message;
    };
    EXPECT_THAT(answer(), Not(HasSubstr("has changed")));  // one sphere is no cell, but it is the file asked for
    std::ofstream(file) << "x,y,z\n1,1,2\n";
    EXPECT_EQ(answer(), "packing: " + file.string() +
                            " has changed since the campaign was read; run the campaign "
                            "file again");
    std::filesystem::remove(file);
    EXPECT_THAT(answer(), HasSubstr("cannot read"));
    // A disk that fails in the middle of the file says nothing about the case: it must not be settled by that.
    std::filesystem::create_symlink("/proc/self/mem", file);
    EXPECT_THROW((void)answer(), SystemError);
    std::filesystem::remove(file);
}

TEST(Compute, ARefusedCheckpointIsNamedAndCostsNoAnswer) {
    const SceneInfo& info = *find_scene("rehearsal");
    campaign::Case question;
    question.scene = info.name;
    question.revision = info.revision;
    question.inputs = info.defaults();
    NoArtefacts none;
    const auto compute = [&](const std::optional<Bytes>& checkpoint) {
        return workers::compute(question, 2, none, checkpoint, [](const Scene&) { return true; }).value();
    };
    const auto calm = compute(std::nullopt);
    EXPECT_EQ(calm.message, "");
    const auto resumed = compute(Bytes(3));
    EXPECT_EQ(resumed.outcome, campaign::Outcome::completed);
    EXPECT_EQ(resumed.observations.scalars, calm.observations.scalars);
    EXPECT_THAT(resumed.message, HasSubstr("its checkpoint was refused (checkpoint of another scene)"));
}

std::vector<double> moments_of(const char* scene, const Inputs& given, std::int64_t frames) {
    const SceneInfo& info = *campaign::scene_named(scene);
    campaign::Case question{"", info.name, info.revision, info.defaults(), 1};
    for (const auto& [name, value] : given) question.inputs.at(name) = value;
    NoArtefacts none;
    std::vector<double> moments;
    const workers::Camera camera{frames, [&](const Scene& seen) { moments.push_back(seen.time()); },
                                 [&](const std::vector<std::size_t>& pictures) {
                                     std::vector<double> kept;
                                     for (const std::size_t k : pictures) kept.push_back(moments.at(k));
                                     moments = kept;
                                 }};
    const auto found = workers::compute(
        question, 1, none, std::nullopt, [](const Scene&) { return true; }, camera);
    EXPECT_EQ(found.value().outcome, campaign::Outcome::completed) << found.value().message;
    return moments;
}

TEST(Camera, TakesAFlowThatVibratesAlwaysAtTheSamePhase) {
    const double frequency = 23300, period = 2 * std::numbers::pi / frequency;
    const auto moments = moments_of("thermovibration",
                                    {{"frequency", frequency},
                                     {"particles", std::int64_t{5}},
                                     {"cells", std::int64_t{6}},
                                     {"steps_per_period", std::int64_t{16}},
                                     {"end_time", 20.4 * period}},
                                    8);
    ASSERT_EQ(moments.size(), 8U);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const double periods = moments[k] / period;
        EXPECT_NEAR(periods, std::round(periods), 1e-6);
        EXPECT_NEAR(periods, 20.0 / 7 * static_cast<double>(k), 0.5 + 1e-6);
    }
}

TEST(Camera, TakesMostPicturesOfTheSweepAndFewOfTheSettling) {
    const auto moments = moments_of("powder_spreading",
                                    {{"diameter", 0.004},
                                     {"width", 3.0},
                                     {"gap", 0.008},
                                     {"layer_area", 1e-4},
                                     {"travel", 0.02},
                                     {"settle_time", 0.1}},
                                    21);
    ASSERT_EQ(moments.size(), 21U);
    // Behind the settling the tool has a way to the edge from which powder is measured.
    const double begin = moments[5], end = 0.1 + 0.02 / 1.4;
    EXPECT_GE(begin, 0.1 - 1e-4);
    EXPECT_LT(begin, 0.1 + 0.4 * 0.02 / 1.4);
    EXPECT_NEAR(moments[20], end, 1e-4);
    for (std::size_t k = 1; k <= 5; ++k) EXPECT_LT(moments[k] - moments[k - 1], 0.35 * begin) << k;
    const double mean = (end - begin) / 15;
    for (std::size_t k = 6; k < 21; ++k) EXPECT_NEAR(moments[k] - moments[k - 1], mean, 0.5 * mean) << k;
}

}  // namespace grainsweep::tests::workers_compute_test
