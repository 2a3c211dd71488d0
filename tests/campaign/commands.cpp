// The commands that need no database, through the real executable.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace grainsweep::tests::commands_test {

using nlohmann::json;

const char* config = R"({"campaign": "c", "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0.1, 0.3]}, {"name": "x2", "between": [0.001, 0.1], "scale": "log"},
              {"name": "response", "levels": ["sum", "ishigami"]}],
  "fixed": {"x3": 0.25}, "design": {"kind": "halton", "points": 20}, "replicates": 2})";

Ended in_folder(const Folder& folder, const std::vector<std::string>& arguments) {
    return grainsweep::tests::run_program(arguments, folder.path());
}

json solved(const Folder& folder, std::vector<std::string> arguments, int code = 0) {
    arguments.insert(arguments.begin(), {"solve", "c.json", "--format", "json"});
    const auto ended = in_folder(folder, arguments);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_EQ(ended.err, "");
    return json::parse(ended.out);
}

TEST(Commands, PlanShowsEveryCaseAndTheCost) {
    const Folder folder;
    folder.write("c.json", config);
    const auto whole = json::parse(in_folder(folder, {"plan", "c.json", "--format", "json"}).out);
    EXPECT_EQ(whole["points"], 20);
    EXPECT_EQ(whole["cases"], 40);
    EXPECT_EQ(whole["rows"].size(), 40U);
    EXPECT_EQ(whole["design"]["scramble"], "random");
    EXPECT_NEAR(whole["predicted_seconds"], 4e-4, 1e-12);
    const auto csv = in_folder(folder, {"plan", "c.json", "--format", "csv"}).out;
    EXPECT_EQ(std::ranges::count(csv, '\n'), 41);
    EXPECT_TRUE(csv.starts_with("point,sequence,replicate,case_id,seed,x1,x2,response\n0,0,0,"));
    const auto text = in_folder(folder, {"plan", "c.json"});
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.out.find("cases      40"), std::string::npos) << text.out;
}

TEST(Commands, PlanRunsACaseAndCountsWhatIsStored) {
    const Folder folder;
    folder.write("c.json", config);
    const auto planned = [&] {
        return json::parse(in_folder(folder, {"plan", "c.json", "--probe", "--format", "json"}).out);
    };
    const auto fresh = planned();
    EXPECT_EQ(fresh["probe"]["outcome"], "completed");
    const double measured = fresh["probe"]["measured_seconds"];
    EXPECT_NEAR(fresh["predicted_seconds"], 40 * measured, 1e-9 + 1e-6 * measured);
    EXPECT_NEAR(fresh["left_seconds"], 40 * measured, 1e-9 + 1e-6 * measured);
    EXPECT_FALSE(std::filesystem::exists(folder / "c.db")) << "nothing is stored";
    EXPECT_NE(in_folder(folder, {"plan", "c.json", "--probe"}).out.find("probe      point "), std::string::npos);
    ASSERT_EQ(in_folder(folder, {"run", "c.json", "--max-cases", "30", "--quiet"}).code, 1);
    const auto later = planned();
    const double again = later["probe"]["measured_seconds"];
    EXPECT_EQ(later["finished"], 30);
    EXPECT_NEAR(later["left_seconds"], 10 * again, 1e-9 + 1e-6 * again);
    ASSERT_EQ(in_folder(folder, {"run", "c.json", "--quiet"}).code, 0);
    EXPECT_EQ(planned()["probe"], nullptr) << "no case is left";
}

TEST(Commands, RunTakesMorePointsOfADesignThatExtends) {
    const Folder folder;
    folder.write("c.json", config);
    ASSERT_EQ(in_folder(folder, {"run", "c.json", "--points", "3", "--quiet"}).code, 0);
    ASSERT_EQ(in_folder(folder, {"run", "c.json", "--points", "24", "--quiet"}).code, 0);
    EXPECT_EQ(
        in_folder(folder, {"query", "c.db", "SELECT count(*) FROM c WHERE outcome = 'completed'"}).out.find("48") ==
            std::string::npos,
        false);
    folder.write("l.json", R"({"campaign": "l", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]}],
      "design": {"kind": "lattice"}})");
    const auto refused = in_folder(folder, {"run", "l.json", "--points", "24"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("a lattice design cannot be extended by points"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "l.db"));
}

TEST(Commands, SolveTakesTheMiddleAndWhatIsSet) {
    const Folder folder;
    folder.write("c.json", config);
    const auto middle = solved(folder, {});
    EXPECT_EQ(middle["inputs"]["x1"], 0.1 + 0.5 * (0.3 - 0.1));
    EXPECT_NEAR(middle["inputs"]["x2"], 0.01, 1e-15);
    EXPECT_EQ(middle["inputs"]["x3"], 0.25);
    EXPECT_EQ(middle["inputs"]["response"], "sum");
    EXPECT_EQ(middle["inputs"].size(), 21U);
    EXPECT_EQ(middle["outcome"], "completed");
    EXPECT_NEAR(middle["scalars"]["y"], 0.2 + 0.01 + 0.25 + 13 * 0.5, 1e-12);
    EXPECT_TRUE(middle["series"].contains("y_series"));
    for (const char* key : {"wall_seconds", "cpu_seconds", "particle_steps", "phases"}) {
        EXPECT_TRUE(middle["cost"].contains(key)) << key;
    }
    const auto set = solved(folder, {"--set", "x1=0.5", "--set", "response=ishigami", "--seed", "7"});
    EXPECT_EQ(set["inputs"]["x1"], 0.5);
    EXPECT_EQ(set["inputs"]["response"], "ishigami");
    EXPECT_EQ(set["seed"], 7);
    EXPECT_EQ(solved(folder, {"--set", "behaviour=unstable"}, 1)["outcome"], "unstable");
}

TEST(Commands, SolveAsksTheCampaignsOwnCase) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0.5, 1]}],
        "fixed": {"noise": 0.5}, "design": {"kind": "lattice"}})");
    const auto planned = json::parse(in_folder(folder, {"plan", "c.json", "--format", "json"}).out)["rows"];
    EXPECT_EQ(solved(folder, {})["case_id"], planned[0]["case_id"]);
    EXPECT_EQ(solved(folder, {"--set", "x1=1"})["seed"], planned[1]["seed"]);
}

TEST(Commands, CataloguesAreOneJsonValueEach) {
    const Folder folder;
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"scenes"}, {"scenes", "rehearsal"}, {"designs"}, {"designs", "lattice"}, {"schema"}}) {
        auto with_format = arguments;
        with_format.insert(with_format.end(), {"--format", "json"});
        const auto ended = in_folder(folder, with_format);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_TRUE(json::accept(ended.out)) << ended.out;
        EXPECT_EQ(in_folder(folder, arguments).code, 0);
    }
    EXPECT_TRUE(json::accept(in_folder(folder, {"schema"}).out));
    EXPECT_TRUE(in_folder(folder, {"schema", "--format", "csv"}).out.starts_with("schema\n\"{"));
}

TEST(Commands, EveryObservableSaysWhatItRunsAlong) {
    const Folder folder;
    for (const auto& scene : json::parse(in_folder(folder, {"scenes", "--format", "json"}).out)) {
        const auto shown = in_folder(folder, {"scenes", scene["scene"], "--format", "json"});
        for (const auto& observable : json::parse(shown.out)["observables"])
            EXPECT_EQ(observable["over"] == "", observable["shape"] == "scalar") << observable;
    }
}

TEST(Commands, AFileOfTheWrongKindIsAWrongQuestion) {
    const Folder folder;
    folder.write("good.csv", "x,y,z\n1,1,1\n3,3,3\n");
    folder.write("header.csv", "a,b,c\n1,1,1\n");
    folder.write("short.csv", "x,y,z\n1,1\n");
    folder.write("none.csv", "");
    const auto planned = [&](const std::string& file) {
        folder.write("c.json", R"({"campaign": "c", "scene": "tpms_discharge", "factors": [{"name": "friction",
            "levels": [0.2]}], "fixed": {"edge": 10, "packing": ")" +
                                   file + R"("}, "design": {"kind": "lattice"}})");
        return in_folder(folder, {"plan", "c.json"});
    };
    EXPECT_EQ(planned("good.csv").code, 0);
    for (const char* file : {"header.csv", "short.csv", "none.csv"}) {
        const auto ended = planned(file);
        EXPECT_EQ(ended.code, 2) << file;
        EXPECT_EQ(ended.err.find("grainsweep: c.json: $.fixed.packing: got \"" + std::string(file) +
                                 "\"; the file is none of the kind asked for: packing, line "),
                  0U)
            << ended.err;
    }
}

TEST(Commands, PlanPassesOverADatabaseThatAKilledRunLeftEmpty) {
    const Folder folder;
    folder.write("c.json", config);
    folder.write(json::parse(config)["campaign"].get<std::string>() + ".db", "");
    EXPECT_EQ(in_folder(folder, {"plan", "c.json"}).code, 0);
}

TEST(Commands, SolveRefusesTheDesignsThatPlanRefuses) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "lattice"}})");
    const auto planned = in_folder(folder, {"plan", "c.json"});
    const auto solved_alone = in_folder(folder, {"solve", "c.json"});
    EXPECT_EQ(planned.code, 2);
    EXPECT_EQ(solved_alone.code, 2);
    EXPECT_EQ(solved_alone.err, planned.err);
}

// What is found only after the file is read names the file all the same.
TEST(Commands, WrongPlansNameTheFile) {
    const Folder folder;
    json wrong = json::parse(config);
    wrong["where"] = "x1 > 2";
    folder.write("c.json", wrong.dump());
    for (const char* command : {"plan", "run"}) {
        const auto ended = in_folder(folder, {command, "c.json"});
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(ended.err.find("grainsweep: c.json: $.where: got \"x1 > 2\"; it leaves none"), 0U) << ended.err;
    }
    wrong["where"] = "x1 >";
    folder.write("c.json", wrong.dump());
    for (const char* command : {"plan", "run", "solve"}) {
        const auto ended = in_folder(folder, {command, "c.json"});
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(ended.err.find("grainsweep: c.json: $.where: "), 0U) << ended.err;
    }
    wrong.erase("where");
    folder.write("c.json", wrong.dump());
    ASSERT_EQ(in_folder(folder, {"run", "c.json", "--quiet"}).code, 0);
    wrong["seed"] = 99;
    folder.write("c.json", wrong.dump());
    const auto other = in_folder(folder, {"run", "c.json", "--quiet"});
    EXPECT_EQ(other.code, 2);
    EXPECT_EQ(other.err.find("grainsweep: c.json: $.seed"), 0U) << other.err;
}

TEST(Commands, WrongArgumentsAreOneSentenceAndTwo) {
    const Folder folder;
    folder.write("c.json", config);
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrongs = {
        {{"plna"}, "grainsweep: there is no command 'plna'; grainsweep --help lists them. Did you mean 'plan'?\n"},
        {{"plan"}, "grainsweep: CONFIG is required.\n"},
        {{"plan", "d.json"}, "grainsweep: d.json: there is no such campaign file. Did you mean 'c.json'?\n"},
        {{"plan", "c.json", "more"}, "grainsweep: plan: there is one argument too many: 'more'.\n"},
        {{"plan", "c.json", "--fromat", "csv"},
         "grainsweep: plan has no option '--fromat'. Did you mean '--format'?\n"},
        {{"plan", "c.json", "--format", "xml"}, "grainsweep: --format: must be 'text', 'csv' or 'json', not 'xml'.\n"},
        {{"solve", "c.json", "--set", "x1"}, "grainsweep: --set: got x1; must be NAME=VALUE.\n"},
        {{"solve", "c.json", "--set", "x1=2"}, "grainsweep: --set x1: got 2; 'x1' must be a number from 0 to 1.\n"},
        {{"solve", "c.json", "--set", "x1=nan"},
         "grainsweep: --set x1: got \"nan\"; 'x1' must be a number from 0 to 1: it begins with no number.\n"},
        {{"solve", "c.json", "--set", "x1=0", "--set", "x1=1"}, "grainsweep: --set x1: this parameter is set twice.\n"},
        {{"solve", "c.json", "--set", "nois=1"},
         "grainsweep: --set nois: scene 'rehearsal' has no parameter of this name. Did you mean 'noise'?\n"},
        {{"scenes", "rehersal"},
         "grainsweep: NAME: got rehersal; there is no such scene; grainsweep scenes lists them. Did you mean "
         "'rehearsal'?\n"},
    };
    for (const auto& [arguments, sentence] : wrongs) {
        const auto ended = in_folder(folder, arguments);
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(ended.err, sentence);
        EXPECT_EQ(ended.out, "");
    }
}

TEST(Commands, AloneTheProgramListsItsCommandsAndEveryHelpEndsWithAnExample) {
    const Folder folder;
    const auto alone = in_folder(folder, {});
    EXPECT_EQ(alone.code, 2);
    EXPECT_EQ(alone.err, "");
    EXPECT_EQ(alone.out, in_folder(folder, {"--help"}).out);
    std::istringstream lines(alone.out.substr(alone.out.find("Subcommands:")));
    std::size_t commands = 0;
    for (std::string line; std::getline(lines, line) && line.find("Example") == std::string::npos;) {
        if (!line.starts_with("  ") || line[2] == ' ') continue;
        const auto name = line.substr(2, line.find(' ', 2) - 2);
        const auto help = in_folder(folder, {name, "--help"}).out;
        const auto at = help.find("Example:\n  grainsweep " + name);
        EXPECT_NE(at, std::string::npos) << name;
        EXPECT_EQ(std::ranges::count(help.substr(at), '\n'), 2) << name << " ends with it";
        ++commands;
    }
    EXPECT_GT(commands, 20U);
}

// The particle loops of a narrower processor, through the whole program: the same answer to single precision, and the
// archive says which it was. A path that this processor lacks is a wrong question.
TEST(Commands, PathForcesTheInstructionSetOfParticles) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "powder_spreading",
        "factors": [{"name": "friction", "levels": [0.2]}],
        "fixed": {"gap": 0.004, "diameter": 0.002, "width": 3, "layer_area": 4e-5, "travel": 0.02, "settle_time": 0.001},
        "design": {"kind": "lattice"}})");
    std::vector<double> rates;
    for (const std::string word : {"avx2", "avx512"}) {
        const auto solved = in_folder(folder, {"solve", "c.json", "--path", word, "--format", "json"});
        const std::string database = word + ".db";
        const auto run = in_folder(folder, {"run", "c.json", "-j", "1", "--db", database, "--path", word, "--quiet"});
        EXPECT_EQ(run.code, solved.code);
        if (solved.code == 2) {
            EXPECT_NE(solved.err.find("--path: got " + word + "; this processor lacks"), std::string::npos)
                << solved.err;
            EXPECT_FALSE(std::filesystem::exists(folder / database));
            continue;
        }
        ASSERT_EQ(solved.code, 0) << solved.err;
        const auto answer = json::parse(solved.out);
        EXPECT_EQ(answer["instruction_path"], word);
        for (const char* name : {"mfr", "packing_fraction", "layer_roughness", "empty_share"})
            EXPECT_TRUE(answer["scalars"].contains(name)) << name << ": null where it is undefined";
        rates.push_back(answer["scalars"]["mfr"]);
        const auto rows = json::parse(
            in_folder(folder, {"query", database, "SELECT instruction_path FROM provenance", "--format", "json"}).out);
        ASSERT_EQ(rows.size(), 1U);
        EXPECT_EQ(rows[0]["instruction_path"], word);
        // The worker computed with the path it was given, and a replay takes the one of the archive by itself.
        const auto id = answer["case_id"].get<std::string>();
        const auto again = in_folder(folder, {"replay", database, id, "--format", "json"});
        EXPECT_EQ(again.code, 0) << again.out;
        EXPECT_EQ(json::parse(again.out)["verdict"], "equal to the last bit");
        const auto elsewhere = in_folder(folder, {"replay", database, id, "--path", "avx2", "--format", "json"});
        EXPECT_EQ(json::parse(elsewhere.out)["same_path"], word == "avx2");
    }
    EXPECT_GE(rates.size(), 1U) << "every supported processor of this family has AVX2";
    for (const char* command : {"solve", "run"}) {
        const auto wrong = in_folder(folder, {command, "c.json", "--path", "avx521"});
        EXPECT_EQ(wrong.code, 2);
        EXPECT_EQ(wrong.err, "grainsweep: --path: got avx521; must be 'avx2' or 'avx512'. Did you mean 'avx512'?\n");
    }
}

TEST(Commands, VersionNamesTheBuild) {
    const Folder folder;
    const auto ended = in_folder(folder, {"--version"});
    EXPECT_EQ(ended.code, 0);
    for (const char* word : {"grainsweep ", "\ncommit ", "\ncompiler ", "\nflags -O", "\ninstruction path "}) {
        EXPECT_NE(ended.out.find(word), std::string::npos) << word << " is not in " << ended.out;
    }
}

}  // namespace grainsweep::tests::commands_test
