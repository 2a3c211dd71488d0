// "accuracy" as an object: a pilot chooses a setting, pairs with `reference` correct it, and the run ends where
// numerics and statistics together are within the tolerance, however it was run.
#include "tests/support/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::accuracy_goal_test {

using nlohmann::json;
using testing::AnyOf;
using testing::HasSubstr;

json narrow_strip(double tolerance) {
    return {{"campaign", "a"},
            {"scene", "powder_spreading"},
            {"factors",
             {{{"name", "friction"}, {"between", {0.1, 0.4}}}, {{"name", "gap"}, {"between", {0.0036, 0.0075}}}}},
            {"fixed", {{"diameter", 0.003}, {"width", 3}, {"layer_area", 1e-4}}},
            {"design", {{"kind", "halton"}, {"sequences", 4}, {"points", 400}}},
            {"accuracy", {{"observable", "mfr"}, {"gates", {"mean"}}, {"tolerance", tolerance}}}};
}

std::string output_of(const Folder& folder, const std::vector<std::string>& arguments) {
    const auto ended = run_program(arguments, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

/// A sentence without the processor time in it.
std::string without_time(std::string text) {
    const auto end = text.find(" core-s"), begin = text.rfind(", ", end);
    EXPECT_NE(end, std::string::npos) << text;
    return text.substr(0, begin);
}

json run_of(const Folder& folder, const std::string& database, const std::string& workers) {
    return json::parse(
        output_of(folder, {"run", "a.json", "--db", database, "-j", workers, "--quiet", "--format", "json"}));
}

TEST(AccuracyGoal, EndsWithinTheToleranceByPairsOfEqualSeeds) {
    const Folder folder;
    folder.write("a.json", narrow_strip(0.2).dump());
    folder.write("a.db", "");  // of a run that was killed before it wrote
    const auto ended = run_of(folder, "a.db", "2");
    EXPECT_EQ(ended["campaign"], "a");
    EXPECT_EQ(ended["converged"], true) << ended;
    EXPECT_THAT(std::string(ended["ending"]), HasSubstr("mfr within 20 % of reference: mean "));
    const auto found = json::parse(output_of(folder, {"converge", "a.db", "--campaign", "a", "--format", "json"}));
    const auto& corrected = found.at(0).at("corrected");
    EXPECT_TRUE(corrected.at("within").get<bool>());
    EXPECT_NE(corrected.at("setting"), "reference");
    EXPECT_THAT(found.at(0).at("notes").dump(),
                HasSubstr("contain its error: the result is the corrected mean and sd"));
    const auto& mean = corrected.at("statistics").at("mean");
    EXPECT_LT(mean.at("error"), 0.2 * mean.at("value").get<double>());
    const auto by_hand = json::parse(output_of(
        folder, {"query", "a.db",
                 "SELECT (SELECT avg(mfr) FROM a) AS uncorrected, count(*) AS pairs, sum(r.seed = a.seed) AS common "
                 "FROM a JOIN a_reference AS r USING (point)",
                 "--format", "json"}))[0];
    EXPECT_NEAR(by_hand["uncorrected"], mean["uncorrected"], 1e-12);
    EXPECT_EQ(by_hand["pairs"], corrected["pairs"]);
    EXPECT_EQ(by_hand["common"], corrected["pairs"]);
    EXPECT_THAT(output_of(folder, {"converge", "a.db", "--campaign", "a"}), HasSubstr("numerics"));
    EXPECT_EQ(run_program({"converge", "a.db", "--campaign", "a", "--check"}, folder.path()).code, 0);

    const auto cases = number_in(folder / "a.db", "SELECT count(*) FROM attempt");
    EXPECT_EQ(run_of(folder, "a.db", "1")["ending"], ended["ending"]) << "nothing is computed again";
    EXPECT_EQ(number_in(folder / "a.db", "SELECT count(*) FROM attempt"), cases);

    // A smaller tolerance continues with the stored cases, at the same setting unless `reference` alone costs less.
    folder.write("a.json", narrow_strip(0.06).dump());
    const auto finer = run_of(folder, "a.db", "2");
    EXPECT_THAT(std::string(finer["ending"]), AnyOf(HasSubstr(" cases at " + corrected["setting"].get<std::string>()),
                                                    HasSubstr(" cases at a cheaper setting, as more pairs cost more")));
    EXPECT_EQ(finer["converged"], true);
    EXPECT_GT(number_in(folder / "a.db", "SELECT count(*) FROM attempt"), cases);
}

TEST(AccuracyGoal, EndsAlikeWithOneAndTwoWorkersAndAfterKills) {
    const Folder folder;
    folder.write("a.json", narrow_strip(0.2).dump());
    const auto ended = run_of(folder, "one.db", "1");
    EXPECT_EQ(without_time(run_of(folder, "two.db", "2")["ending"]), without_time(ended["ending"]));
    const auto calm = output_of(folder, {"dump", "one.db"});
    EXPECT_EQ(output_of(folder, {"dump", "two.db"}), calm);
    for (const int after : {5, 40, 70}) {
        Process killed(program_command({"run", "a.json", "--db", "killed.db", "-j", "2"}), folder.path());
        await_settled(killed, folder / "killed.db", after);
        killed.signal(SIGKILL);
        killed.wait();
    }
    EXPECT_EQ(without_time(run_of(folder, "killed.db", "2")["ending"]), without_time(ended["ending"]));
    EXPECT_EQ(output_of(folder, {"dump", "killed.db"}), calm);
    // And in pieces.
    for (int i = 0; i < 3; ++i) {
        const auto part =
            run_program({"run", "a.json", "--db", "parts.db", "--max-cases", "20", "--quiet"}, folder.path());
        EXPECT_EQ(part.code, 1) << part.err;
    }
    (void)run_of(folder, "parts.db", "2");
    EXPECT_EQ(output_of(folder, {"dump", "parts.db"}), calm);
}

/// Cases of so few particles that those of one seed at two settings hardly resemble each other.
json scattering_strip(int seed) {
    auto file = narrow_strip(0.05);
    file["accuracy"]["setting"] = "survey";
    file["fixed"]["layer_area"] = 5e-5;
    file["seed"] = seed;
    return file;
}

TEST(AccuracyGoal, GivesUpPairsThatCostMoreThanTheReferenceAlone) {
    const Folder folder;
    json ended;
    int seed = 0;
    for (const int one : {3, 9, 6, 11}) {  // few pairs are enough for most; which ones depends on the instruction path
        seed = one;
        folder.write("a.json", scattering_strip(seed).dump());
        std::filesystem::remove(folder / "calm.db");
        ended = run_of(folder, "calm.db", "2");
        if (std::string(ended["ending"]).find("more pairs cost more") != std::string::npos) break;
    }
    EXPECT_EQ(ended["campaign"], "a");
    EXPECT_EQ(ended["converged"], true) << ended;
    EXPECT_THAT(std::string(ended["ending"]), HasSubstr("at a cheaper setting, as more pairs cost more"));
    const auto found = json::parse(output_of(folder, {"converge", "calm.db", "--campaign", "a", "--format", "json"}));
    const auto& corrected = found.at(0).at("corrected");
    EXPECT_EQ(corrected["setting"], "reference");
    EXPECT_EQ(corrected["pairs"], 0);
    EXPECT_EQ(corrected["within"], true);
    const auto by_hand = json::parse(output_of(
        folder,
        {"query", "calm.db", "SELECT avg(mfr) AS mean, count(*) AS cases FROM a_reference", "--format", "json"}))[0];
    EXPECT_NEAR(by_hand["mean"], corrected["statistics"]["mean"]["value"], 1e-12);
    EXPECT_EQ(by_hand["cases"], corrected["cases"]);

    const auto calm = output_of(folder, {"dump", "calm.db"});
    EXPECT_EQ(run_of(folder, "calm.db", "1")["ending"], ended["ending"]) << "nothing is computed again";
    EXPECT_EQ(output_of(folder, {"dump", "calm.db"}), calm);
    for (const int after : {5, 30, 50, 60}) {
        Process killed(program_command({"run", "a.json", "--db", "killed.db", "-j", "2"}), folder.path());
        await_settled(killed, folder / "killed.db", after);
        killed.signal(SIGKILL);
        killed.wait();
    }
    EXPECT_EQ(without_time(run_of(folder, "killed.db", "2")["ending"]), without_time(ended["ending"]));
    EXPECT_EQ(output_of(folder, {"dump", "killed.db"}), calm);

    // With a larger tolerance the pairs suffice, and their answer counts again.
    auto larger = scattering_strip(seed);
    larger["accuracy"]["tolerance"] = 0.5;
    folder.write("a.json", larger.dump());
    EXPECT_THAT(std::string(run_of(folder, "calm.db", "2")["ending"]), HasSubstr(" cases at survey and "));
}

TEST(AccuracyGoal, OfTheReferenceAloneNeedsNoPairs) {
    const Folder folder;
    auto file = narrow_strip(0.3);
    file["accuracy"]["setting"] = "reference";
    folder.write("a.json", file.dump());
    const std::string ending = run_of(folder, "a.db", "2")["ending"];
    EXPECT_THAT(ending, HasSubstr("numerics 0 %"));
    EXPECT_THAT(ending, HasSubstr("cases at reference, "));
    EXPECT_EQ(number_in(folder / "a.db", "SELECT count(*) FROM campaign"), 1);
}

TEST(AccuracyGoal, OfAMachineReadsItsFileAtEverySetting) {
    const Folder folder;
    const json file = {{"campaign", "a"},
                       {"scene", "machine"},
                       {"machine", "heap"},
                       {"factors", {{{"name", "friction"}, {"between", {0.2, 0.8}}}}},
                       {"fixed", {{"youngs_modulus", 2e5}, {"particles", 40}, {"diameter", 0.005}, {"end_time", 0.3}}},
                       {"design", {{"kind", "halton"}, {"sequences", 4}, {"points", 64}}},
                       {"accuracy", {{"observable", "angle_moment"}, {"gates", {"mean"}}, {"tolerance", 0.9}}}};
    folder.write("a.json", file.dump());
    const std::string ending = run_of(folder, "a.db", "2")["ending"];
    EXPECT_THAT(ending, HasSubstr("angle_moment within 90 % of reference"));
    EXPECT_EQ(number_in(folder / "a.db", "SELECT count(*) FROM campaign"), 5)
        << "the goal and a pilot of four settings";
}

TEST(AccuracyGoal, WrongQuestionsAreOneSentence) {
    const Folder folder;
    const auto says = [&](const json& patch, const std::string& command = "run") {
        auto file = narrow_strip(0.2);
        file.merge_patch(patch);
        folder.write("a.json", file.dump());
        const auto ended = run_program(command == "work" ? std::vector<std::string>{"work", "a.json", "--spool", "s"}
                                                         : std::vector<std::string>{command, "a.json"},
                                       folder.path());
        EXPECT_EQ(ended.code, 2) << ended.out;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.db"));
        return ended.err;
    };
    EXPECT_THAT(says({{"accuracy", {{"observable", "mfrr"}}}}), HasSubstr("Did you mean 'mfr'?"));
    EXPECT_THAT(says({{"accuracy", {{"setting", "fats"}}}}), HasSubstr("Did you mean 'fast'?"));
    EXPECT_THAT(says({{"accuracy", {{"tolerance", 0}}}}), HasSubstr("$.accuracy.tolerance"));
    EXPECT_THAT(says({{"accuracy", {{"gates", {"kurtosis"}}}}}), HasSubstr("$.accuracy.gates"));
    EXPECT_THAT(says({{"accuracy", {{"tolerances", 0.1}}}}), HasSubstr("Did you mean 'tolerance'?"));
    EXPECT_THAT(says({{"convergence", {{"observable", "mfr"}}}}), HasSubstr("leave one of them out"));
    EXPECT_THAT(says({{"replicates", 2}}), HasSubstr("one run of each point"));
    EXPECT_THAT(says({{"fixed", {{"time_step_fraction", 0.2}, {"precision", "mixed"}, {"settle_time", 0.1}}}}),
                HasSubstr("they would agree whatever their error"));
    EXPECT_THAT(says({{"design", {{"sequences", 1}}}}), HasSubstr("\"sequences\" of at least 4"));
    EXPECT_THAT(says({{"design", {{"points", 12}}}}), HasSubstr("at least 4 points for each"));
    EXPECT_THAT(says({{"factors", {{{"name", "gap"}, {"between", {0.0036, 0.0075}}, {"step", 0.0005}}}}}),
                HasSubstr("different cases at all points"));
    EXPECT_THAT(says({{"factors", {{{"name", "gap"}, {"levels", {0.004, 0.005}}}}}}),
                HasSubstr("a factor with a range"));
    EXPECT_THAT(says(json::object(), "work"), HasSubstr("use run, or name a setting"));
}

// Cases of one setting that were computed elsewhere are taken where the run comes to them, and give the same end.
TEST(AccuracyGoal, TakesOldResultsOfOneSetting) {
    const Folder folder;
    folder.write("a.json", narrow_strip(0.2).dump());
    const auto computed = run_of(folder, "a.db", "2");
    folder.write("old.csv", output_of(folder, {"query", "a.db", "SELECT * FROM a_reference", "--format", "csv"}));
    const auto unnamed = run_program({"import", "old.csv", "a.json", "b.db"}, folder.path());
    EXPECT_EQ(unnamed.code, 2);
    EXPECT_THAT(unnamed.err, HasSubstr("reference, survey: lines belong to one setting of the numerics"));
    const auto said = output_of(folder, {"import", "old.csv", "a.json", "b.db", "--accuracy", "reference"});
    EXPECT_THAT(said, HasSubstr("imported into 'a_reference'"));
    const auto ended = run_of(folder, "b.db", "2");
    EXPECT_EQ(ended["converged"], true);
    const auto corrected = [&](const std::string& database) {
        return json::parse(
            output_of(folder, {"converge", database, "--campaign", "a", "--format", "json"}))[0]["corrected"];
    };
    EXPECT_EQ(corrected("b.db")["statistics"], corrected("a.db")["statistics"]);
    const auto times = "SELECT count(*) AS n FROM a_reference WHERE wall_seconds IS NOT NULL";
    const auto rows = json::parse(output_of(folder, {"query", "b.db", times, "--format", "json"}));
    EXPECT_EQ(rows.at(0).at("n"), 0) << "no case of reference was computed again";
}

}  // namespace grainsweep::tests::accuracy_goal_test
