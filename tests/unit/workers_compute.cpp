// What a worker refuses to compute.
#include "sweep/workers/compute.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "solver/scenes/scene.hpp"

using namespace grainsweep;
using testing::HasSubstr;
using testing::Not;

TEST(Compute, RejectsACaseWhoseFileHasChanged) {
    const auto file = std::filesystem::temp_directory_path() / "grainsweep_compute_packing.csv";
    const std::string contents = "x,y,z\n1,1,1\n";
    std::ofstream(file) << contents;
    const SceneInfo& info = *find_scene("tpms_discharge");
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
}
