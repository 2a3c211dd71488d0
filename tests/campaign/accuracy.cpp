// Error against cost through the real program: the same points at every setting with the same random numbers.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::accuracy_test {

using nlohmann::json;
using testing::HasSubstr;

json spreading(const json& fixed) {
    json campaign = {{"campaign", "a"},
                     {"scene", "powder_spreading"},
                     {"factors", {{{"name", "friction"}, {"between", {0.1, 0.5}}}}},
                     {"fixed", {{"width", 3}, {"layer_area", 1e-4}}},
                     {"design", {{"kind", "halton"}, {"points", 8}}}};
    campaign["fixed"].update(fixed);
    return campaign;
}

TEST(Accuracy, EverySettingIsComparedPointByPointAndResumes) {
    const Folder folder;
    folder.write("a.json", spreading(json::object()).dump());
    const std::vector<std::string> arguments = {"accuracy", "a.json",  "--points", "3",   "--against",
                                                "balanced", "--quiet", "--format", "json"};
    const auto first = run_program(arguments, folder.path());
    ASSERT_EQ(first.code, 0) << first.err;
    const auto warning = first.err.find("warning: narrow layer");
    ASSERT_NE(warning, std::string::npos) << first.err;
    EXPECT_EQ(first.err.find("warning: narrow layer", warning + 1), std::string::npos) << "once for all settings";
    const auto found = json::parse(first.out);
    std::vector<std::string> settings;
    for (const auto& one : found["settings"]) {
        settings.push_back(one["setting"]);
        EXPECT_EQ(one["answered"], 3);
        EXPECT_GT(one["core_seconds"], 0);
    }
    EXPECT_THAT(settings, testing::IsSupersetOf({"fast", "reference", "balanced"}));
    EXPECT_EQ(settings.back(), "balanced");
    // The mean difference is that of the answers in the database.
    const auto query = run_program(
        {"query", "a_accuracy.db",
         "SELECT avg(f.mfr - b.mfr) AS bias FROM a_fast AS f JOIN a_balanced AS b USING (point)", "--format", "json"},
        folder.path());
    const double bias = json::parse(query.out)[0]["bias"];
    for (const auto& one : found["settings"]) {
        if (one["setting"] != "fast") continue;
        for (const auto& of : one["biases"]) {
            if (of["observable"] == "mfr") {
                EXPECT_NEAR(of["bias"], bias, 1e-12);
            }
        }
    }
    // Common random numbers: seeds are equal where the numerics differ alone.
    const auto seeds = run_program({"query", "a_accuracy.db",
                                    "SELECT count(*) AS n FROM a_fast AS f JOIN a_balanced AS b USING (point) "
                                    "WHERE f.seed = b.seed AND f.case_id <> b.case_id",
                                    "--format", "json"},
                                   folder.path());
    EXPECT_EQ(json::parse(seeds.out)[0]["n"], 3) << seeds.err;
    const auto again = run_program(arguments, folder.path());
    EXPECT_EQ(again.out, first.out) << "nothing is computed again";
    EXPECT_FALSE(std::filesystem::exists(folder / "a_fast.json"));
}

std::vector<std::string> settings_in(const json& found) {
    std::vector<std::string> settings;
    for (const auto& one : found["settings"]) settings.push_back(one["setting"]);
    return settings;
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Accuracy, ErrorAgainstCostIsDrawn) {
    const Folder folder;
    folder.write("a.json", spreading(json::object()).dump());
    std::vector<std::string> arguments = {"accuracy", "a.json",       "--points", "2",       "--against",
                                          "balanced", "--observable", "mfr",      "--quiet", "-o",
                                          "a.svg",    "--format",     "json"};
    const auto ended = run_program(arguments, folder.path());
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto drawn = text_of(folder / "a.svg");
    EXPECT_TRUE(drawn.starts_with("<?xml")) << drawn.substr(0, 80);
    // The standard deviation of the answers, for the error of a mean.
    const auto query =
        run_program({"query", "a_accuracy.db", "SELECT mfr FROM a_fast", "--format", "json"}, folder.path());
    const auto values = json::parse(query.out);
    const double apart = double(values[0]["mfr"]) - double(values[1]["mfr"]);
    int compared = 0;
    const auto settings = json::parse(ended.out)["settings"];
    for (const auto& setting : settings)
        for (const auto& of : setting["biases"])
            if (setting["setting"] == "fast" && of["observable"] == "mfr") {
                EXPECT_NEAR(of["spread"], std::abs(apart) / std::sqrt(2.0), 1e-12);
                ++compared;
            }
    EXPECT_EQ(compared, 1);
    ASSERT_EQ(run_program(arguments, folder.path()).code, 0);
    EXPECT_EQ(text_of(folder / "a.svg"), drawn) << "the same numbers, the same bytes";
    arguments[7] = "tool_force";
    const auto nothing = run_program(arguments, folder.path());
    EXPECT_EQ(nothing.code, 2) << "the force on the tool is 0 in every case";
    EXPECT_THAT(nothing.err, HasSubstr("there is nothing to draw"));
    arguments[7] = "mfr";
    std::filesystem::remove(folder / "a_accuracy.db");
    arguments[10] = "a.txt";
    const auto refused = run_program(arguments, folder.path());
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("must end in .pdf, .svg or .png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a_accuracy.db")) << "nothing is computed for a wrong question";
}

TEST(Accuracy, StiffnessIsMovedInScenesAndMachinesUnlessTheCampaignVariesIt) {
    const Folder folder;
    const auto settings_of = [&](const json& campaign) {
        folder.write("a.json", campaign.dump());
        const auto ended =
            run_program({"accuracy", "a.json", "--points", "2", "--quiet", "--format", "json"}, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        std::filesystem::remove(folder / "a_accuracy.db");
        return settings_in(json::parse(ended.out));
    };
    auto stiff = spreading({{"youngs_modulus", 3e6}, {"width", 3}});
    auto found = settings_of(stiff);
    EXPECT_THAT(found,
                testing::IsSupersetOf({"reference with stiffness_scale = 0.1", "reference with stiffness_scale = 10"}));
    EXPECT_THAT(found, testing::IsSupersetOf({"fine", "reference with time_step_fraction = 0.2"}));
    EXPECT_THAT(found, testing::Not(testing::Contains("reference with precision = mixed"))) << "that is fine";
    stiff["factors"].push_back({{"name", "stiffness_scale"}, {"between", {0.5, 2}}});
    EXPECT_THAT(settings_of(stiff), testing::Not(testing::Contains(HasSubstr("stiffness_scale"))));
    const json drum = {{"campaign", "a"},
                       {"scene", "rotating_drum"},
                       {"factors", {{{"name", "friction"}, {"between", {0.2, 0.8}}}}},
                       {"fixed",
                        {{"drum_diameter", 0.03},
                         {"length", 0.02},
                         {"particles", 20},
                         {"turning_time", 0.05},
                         {"measured_time", 0.05}}},
                       {"design", {{"kind", "halton"}, {"points", 8}}}};
    EXPECT_THAT(settings_of(drum),
                testing::IsSupersetOf({"reference with stiffness_scale = 0.1", "reference with stiffness_scale = 10"}));
}

TEST(Accuracy, KeepsThePowderOfTheCampaign) {
    const Folder folder;
    folder.write("p.json", json({{"powder", "p"},
                                 {"material", {{"density", 4000}, {"youngs_modulus", 2e7}, {"poisson_ratio", 0.3}}},
                                 {"contacts", {{"friction", 0.3}, {"restitution", 0.5}}}})
                               .dump());
    auto campaign = spreading(json::object());
    campaign["powder"] = "p.json";
    folder.write("a.json", campaign.dump());
    const auto ended =
        run_program({"accuracy", "a.json", "--points", "2", "--quiet", "--format", "json"}, folder.path());
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto rows = run_program(
        {"query", "a_accuracy.db", "SELECT fixed FROM campaign WHERE name = 'a_reference'", "--format", "json"},
        folder.path());
    EXPECT_THAT(rows.out, HasSubstr("density = 4000")) << rows.err;
}

TEST(Accuracy, ANumericalInputThatTheFileHoldsIsNotMoved) {
    const Folder folder;
    folder.write("a.json", spreading({{"precision", "mixed"}}).dump());
    const auto ended = run_program(
        {"accuracy", "a.json", "--points", "2", "--against", "fast", "--quiet", "--format", "csv"}, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::Not(HasSubstr("precision")));
}

TEST(Accuracy, WrongQuestionsAreOneSentence) {
    const Folder folder;
    folder.write("a.json", spreading(json::object()).dump());
    folder.write("r.json", json({{"campaign", "r"},
                                 {"scene", "rehearsal"},
                                 {"factors", {{{"name", "x1"}, {"between", {0, 1}}}}},
                                 {"design", {{"kind", "halton"}, {"points", 8}}}})
                               .dump());
    const auto says = [&](const std::vector<std::string>& arguments) {
        const auto ended = run_program(arguments, folder.path());
        EXPECT_EQ(ended.code, 2) << ended.out;
        return ended.err;
    };
    EXPECT_THAT(says({"accuracy", "a.json", "--against", "refernce"}), HasSubstr("Did you mean 'reference'?"));
    EXPECT_THAT(says({"accuracy", "r.json"}), HasSubstr("has no accuracy settings"));
    folder.write("p.json", R"({"campaign": "p", "scene": "program", "factors": [{"name": "x", "between": [0, 1]}],
        "program": {"command": ["awk", "{x}"], "observables": {"y": {"from": {"json": "out.json", "path": "/y"}}}},
        "design": {"kind": "halton", "points": 8}})");
    EXPECT_THAT(says({"accuracy", "p.json"}), HasSubstr("scene 'program awk' has no accuracy settings"));
    EXPECT_THAT(says({"accuracy", "a.json", "--tolerance", "2"}), HasSubstr("--tolerance"));
    EXPECT_THAT(says({"accuracy", "a.json", "--points", "1"}), HasSubstr("from 2"));
    folder.write("a_fast.json", "{}");
    EXPECT_THAT(says({"accuracy", "a.json", "--quiet"}), HasSubstr("a file of this name exists"));
}

}  // namespace grainsweep::tests::accuracy_test
