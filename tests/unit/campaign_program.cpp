// "program" of a campaign file: what is read, what is refused with which sentence, and what is identity.
#include "sweep/campaign/output_pattern.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>

namespace grainsweep::tests::campaign_program_test {

using namespace campaign;
using nlohmann::json;

namespace fs = std::filesystem;

/// A folder with some files to name.
class Beside {
public:
    Beside() : path_(fs::temp_directory_path() / ("grainsweep-program-" + std::to_string(::getpid()))) {
        fs::create_directories(path_ / "mesh");
        write("run.py", "print(1)\n");
        write("in.deck", "friction {{ mu }} seed {{seed31}}\n");
        write("mesh/drum.stl", "solid\n");
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
    ~Beside() { fs::remove_all(path_); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

json sound_file() {
    return json::parse(R"json({"campaign": "c", "scene": "program",
      "program": {"command": ["python3", "run.py", "-mu={mu}", "{{mu}}"], "files": ["run.py", "mesh/drum.stl"],
        "templates": ["in.deck"],
        "parameters": {"mu": {"unit": "1", "bounds": [0, 2], "meaning": "friction"}},
        "observables": {
          "angle": {"unit": "deg", "from": {"json": "r.json", "path": "/angle"}},
          "flow": {"from": {"csv": "flow.csv", "column": "rate", "row": "first"}},
          "shape": {"from": {"csv": "flow.csv", "column": "h", "over": "x"}},
          "energy": {"from": {"output": "E = ([0-9.]+)"}}},
        "environment": {"OMP_NUM_THREADS": "{threads}"}, "cores": 2, "memory": "4 GB", "keep": "all"},
      "factors": [{"name": "mu", "between": [0.1, 0.9]}, {"name": "law", "levels": ["jkr", "dmt"]}],
      "fixed": {"n": 1000000},
      "design": {"kind": "halton", "points": 4}})json");
}

/// What is said of a campaign file; empty: it is read.
std::string said_of(const json& file, const Beside& beside) {
    try {
        (void)parse_campaign(file.dump(), beside.path());
        return {};
    } catch (const WrongQuestion& wrong) {
        return wrong.what();
    }
}

TEST(ProgramSection, IsReadAndMadeAScene) {
    const Beside beside;
    const auto campaign = parse_campaign(sound_file().dump(), beside.path());
    EXPECT_TRUE(is_program(campaign.scene().name));
    const auto program = known_program(campaign.scene().name);
    ASSERT_NE(program, nullptr);
    EXPECT_EQ(program->memory, 4'000'000'000);
    EXPECT_EQ(program->files.size(), 3U);
    EXPECT_EQ(campaign.scene().find_parameter("mu")->unit, "1");
    EXPECT_EQ(campaign.scene().find_observable("shape")->shape, Shape::profile);
    const auto again = program_in(program_text(*program));
    EXPECT_EQ(program_scene_name(again), campaign.scene().name);
    EXPECT_EQ(program_text(again), program_text(*program));
}

// What a database of anybody holds is read by the rules of a campaign file: its hash is no signature.
TEST(ProgramDefinition, FromElsewhereIsRefusedByTheRulesOfACampaignFile) {
    const Beside beside;
    const auto campaign = parse_campaign(sound_file().dump(), beside.path());
    const auto as_written = json::parse(program_text(*known_program(campaign.scene().name)));
    const auto refused = [&](const json& patch) -> std::string {
        json altered = as_written;
        altered.merge_patch(patch);
        try {
            (void)program_in(altered.dump());
        } catch (const std::invalid_argument& why) {
            return why.what();
        }
        return {};
    };
    EXPECT_EQ(refused(json::object()), "");
    const std::string hash(32, 'a');
    for (const std::string name :
         {"../OWNED", "mesh/../../OWNED", "..", "/tmp/OWNED", "a//b", "./a", "", "a\nb", "mesh/"}) {
        for (const char* kind : {"files", "templates"})
            EXPECT_NE(refused({{"answer", {{kind, {{name, hash}}}}}}).find("outside of the case's folder"),
                      std::string::npos)
                << kind << ' ' << name;
        EXPECT_NE(refused({{"answer", {{"observables", {{"angle", {{"from", {{"json", name}}}}}}}}}}), "") << name;
        EXPECT_NE(refused({{"answer", {{"observables", {{"flow", {{"from", {{"csv", name}}}}}}}}}}), "") << name;
    }
    for (const std::string other : {"../../../OWNED", "", "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"})
        EXPECT_NE(refused({{"answer", {{"files", {{"run.py", other}}}}}}), "") << other;
    EXPECT_NE(refused({{"answer", {{"command", json::array()}}}}).find("its command is empty"), std::string::npos);
    EXPECT_NE(refused({{"answer", {{"command", {""}}}}}), "");
    EXPECT_NE(refused({{"settings", {{"cores", 0}}}}), "");
    EXPECT_NE(refused({{"settings", {{"memory", -1}}}}), "");
    EXPECT_NE(refused({{"settings", {{"disk", -1}}}}), "");
    EXPECT_NE(refused({{"settings", {{"order", {"no such"}}}}}), "");
}

TEST(ProgramSection, ARegularExpressionHasAnEnd) {
    const Beside beside;
    auto file = sound_file();
    file["program"]["observables"]["energy"]["from"]["output"] = R"((['"])([0-9.]+)\1)";
    EXPECT_NE(said_of(file, beside).find("without back-references"), std::string::npos);
    for (const char* pattern : {"(a+)+$", "(a|a)*b", "(a|aa)+$", "(.*a){12}$", "(([a-z])+.)+[A-Z]([a-z])+$"}) {
        const auto searched = output_pattern(pattern);
        const std::string line = std::string(60, 'a') + "!";  // one way after another: 2^60 of them
        EXPECT_FALSE(std::regex_search(line, searched)) << pattern;
    }
    std::smatch found;
    const std::string line = "step 3 E = 1.25e-3 J (total 5)";
    ASSERT_TRUE(std::regex_search(line, found, output_pattern("E = ([-+0-9.eE]+)")));
    EXPECT_EQ(found[1], "1.25e-3");
    ASSERT_TRUE(std::regex_search(line, found, output_pattern(R"(\w+ .*?(\d+)\))")));
    EXPECT_EQ(found[1], "5");
}

TEST(ProgramSection, RefusesWithOneSentence) {
    const Beside beside;
    fs::create_symlink("/etc/passwd", beside.path() / "out");
    fs::create_symlink("mesh", beside.path() / "inside");
    ASSERT_EQ(said_of(sound_file(), beside), "");
    struct Refused {
        json patch;
        std::string says;
    };
    const std::vector<Refused> all = {
        {{{"program", {{"files", {"../secret"}}}}},
         "$.program.files[0]: got \"../secret\"; must be a file name within"},
        {{{"program", {{"files", {"/etc/passwd"}}}}}, "no absolute path"},
        {{{"program", {{"files", {"mesh/../../x"}}}}}, "no '..'"},
        {{{"program", {{"files", {"out"}}}}}, "it is a link that leaves the folder of the campaign file"},
        {{{"program", {{"files", {"a\nb"}}}}}, "no control characters"},
        {{{"program", {{"files", {"run.pi"}}}}}, "there is no such file beside the campaign file"},
        {{{"program", {{"files", {"run.py", "run.py"}}}}}, "this file is there twice"},
        {{{"program", {{"files", {"mesh"}}}}}, "there is no such file"},
        {{{"program", {{"command", json::array()}}}}, "needs a program and its arguments"},
        {{{"program", {{"command", {"x", "{mo}"}}}}}, "$.program.command[1]: got mo; is neither a factor nor a fixed"},
        {{{"program", {{"command", {"./other"}}}}}, "among \"files\""},
        {{{"program", {{"command", {"./run.py"}}}}}, "this file is not executable"},
        {{{"program", {{"parameters", {{"nu", {{"unit", "1"}}}}}}}}, "$.program.parameters.nu"},
        {{{"program", {{"memory", "4 furlongs"}}}}, "must be a number and a unit"},
        {{{"program", {{"environment", {{"A=B", "1"}}}}}}, "the name of a variable"},
        {{{"program", {{"observables", {{"a b", {{"from", {{"output", "(x)"}}}}}}}}}}, "it names a column in SQL"},
        {{{"program", {{"observables", {{"angle", {{"from", {{"path", nullptr}}}}}}}}}}, "\"json\" needs \"path\""},
        {{{"program", {{"observables", {{"angle", {{"from", {{"json", "../r.json"}}}}}}}}}}, "no '..'"},
        {{{"program", {{"observables", {{"angle", {{"from", {{"csv", "r.csv"}}}}}}}}}}, "found in one place"},
        {{{"program", {{"observables", {{"energy", {{"from", {{"output", "(["}}}}}}}}}}, "is no regular expression"},
        {{{"program", {{"observables", {{"energy", {{"from", {{"output", "abc"}}}}}}}}}}, "needs a group"},
        {{{"program", {{"observables", {{"energy", {{"shape", "profile"}}}}}}}}, "needs \"over\""},
        {{{"program", {{"protocol", "lines"}}}}, "comes in the reply"},
        {{{"fixed", {{"seed", 1}}}}, "is the program's name for something else"},
        {{{"fixed", {{"law2", "a\tb"}}}}, "no control characters"},
        {{{"fixed", {{"law2", "file:x"}}}}, "does not begin with 'file:'"},
        {{{"fixed", {{"mu", 0.5}}}}, "is also a factor"},
        {{{"scene", "heap"}}, "belongs to \"scene\": \"program\""},
        {{{"program", nullptr}}, "key 'program' is missing"},
        {{{"accuracy", "fast"}}, "offers no accuracy settings"},
    };
    for (const auto& [patch, says] : all) {
        json file = sound_file();
        file.merge_patch(patch);
        const auto said = said_of(file, beside);
        EXPECT_NE(said.find(says), std::string::npos) << patch << "\n  " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    json file = sound_file();
    file["program"]["files"] = {"run.py", "inside/drum.stl"};
    EXPECT_EQ(said_of(file, beside), "") << "a link within the folder";
    file["factors"][0]["between"] = {0.1, 2.5};
    EXPECT_NE(said_of(file, beside).find("'mu' must be a number from 0 to 2"), std::string::npos);
}

/// SQL has one name for `a` and `A`. Suffixes distinguish a factor from an observable of the same name.
TEST(ProgramSection, NamesThatDifferByCaseAreOne) {
    const Beside beside;
    const auto said = [&](const json& patch) {
        json file = sound_file();
        file.merge_patch(patch);
        return said_of(file, beside);
    };
    EXPECT_NE(said({{"fixed", {{"MU", 1}}}}).find("$.fixed.MU: got MU; mu and MU are one name in SQL; rename one"),
              std::string::npos)
        << said({{"fixed", {{"MU", 1}}}});
    EXPECT_NE(said({{"fixed", {{"Mu", "a"}}}}).find("mu and Mu are one name in SQL"), std::string::npos);
    EXPECT_NE(said({{"program", {{"observables", {{"Energy", {{"from", {{"output", "(x)"}}}}}}}}}})
                  .find("Energy and energy are one name in SQL"),
              std::string::npos);
    json file = sound_file();
    file["factors"].push_back({{"name", "mU"}, {"between", {0, 1}}});
    EXPECT_NE(said_of(file, beside).find("mu and mU are one name in SQL"), std::string::npos);
    file = sound_file();
    file["factors"].push_back({{"name", "ENERGY"}, {"between", {0, 1}}});
    EXPECT_EQ(said_of(file, beside), "");
}

TEST(ProgramSection, AWholeNumberIsVariedByLevels) {
    const Beside beside;
    const auto said = [&](const json& range, const json& fixed, const json& whole) {
        json file = sound_file();
        json factor = {{"name", "layers"}};
        factor.update(range);
        file["factors"].push_back(factor);
        file["fixed"]["rounds"] = fixed;
        file["program"]["parameters"] = {{"layers", {{"whole", whole}}}, {"rounds", {{"whole", true}}}};
        return said_of(file, beside);
    };
    EXPECT_EQ(said({{"levels", {1, 2.0, 1e3}}}, 4, true), "");
    EXPECT_EQ(said({{"between", {1, 10}}}, 4, false), "");
    EXPECT_EQ(said({{"between", {1, 10}}, {"whole", true}}, 4, true), "");
    EXPECT_EQ(said({{"between", {1, 10}}, {"step", 3}}, 4, true), "");
    EXPECT_NE(said({{"between", {1, 10}}}, 4, true)
                  .find("'layers' is a whole number: add \"whole\": true, or vary it by \"levels\""),
              std::string::npos);
    EXPECT_NE(said({{"levels", {1, 2.5}}}, 4, true).find("got 2.5; 'layers' is a whole number"), std::string::npos);
    EXPECT_NE(said({{"levels", {1, 2}}}, 4.5, true).find("$.fixed.rounds: got 4.5; 'rounds' is a whole number"),
              std::string::npos);
    EXPECT_NE(said({{"levels", {"a", "b"}}}, 4, true).find("the values of this parameter are words"),
              std::string::npos);
}

TEST(ProgramSection, TemplatesNameWhatThereIs) {
    const Beside beside;
    beside.write("in.deck", "mu\n{{ mo }}\n");
    EXPECT_NE(said_of(sound_file(), beside).find("Did you mean 'mu'?"), std::string::npos);
    beside.write("in.deck", "mu\n{{ mu * 2 }}\n");
    EXPECT_NE(said_of(sound_file(), beside).find("line 2: '{{ mu * 2 }}' holds no name"), std::string::npos);
}

TEST(Placeholders, AreReplacedAndBracesStay) {
    const ValueOf value = [](std::string_view name) { return "<" + std::string(name) + ">"; };
    EXPECT_EQ(filled_command("a{x}b {y_1}", value), "a<x>b <y_1>");
    EXPECT_EQ(filled_command("{{x}} {} { x } {1} {a-b} }{ {", value), "{x} {} { x } {1} {a-b} }{ {");
    EXPECT_EQ(filled_template("a {{ x }}{{y}}\n{x} {{\n}} {{", value), "a <x><y>\n{x} {{\n}} {{");
    EXPECT_THROW((void)filled_template("{{}}", value), std::invalid_argument);
}

TEST(Placeholders, NumbersAreShownForPrograms) {
    EXPECT_EQ(program_value(Value{1e6}), "1000000");
    EXPECT_EQ(program_value(Value{-3.0}), "-3");
    EXPECT_EQ(program_value(Value{0.1}), "0.1");
    EXPECT_EQ(program_value(Value{1e300}), "1e+300");
    EXPECT_EQ(program_value(Value{std::string("jkr")}), "jkr");
    EXPECT_EQ(json::parse(program_question("id", 7, 2, {{"a", 1e6}, {"b", std::string("\"q\" \xC3\xA4")}})),
              json::parse(R"({"case": "id", "seed": 7, "threads": 2, "inputs": {"a": 1000000, "b": "\"q\" \u00e4"}})"));
}

TEST(ProgramSection, TheHashIsOfWhatChangesAnAnswer) {
    const Beside beside;
    const auto name_of = [&](const json& patch) {
        json file = sound_file();
        if (patch.is_object()) file.merge_patch(patch);
        return parse_campaign(file.dump(), beside.path()).scene().name;
    };
    const auto same = name_of({});
    EXPECT_EQ(same, name_of({{"program", {{"cores", 2}, {"keep", "none"}, {"memory", "1 GB"}, {"tolerance", 0.1}}}}));
    EXPECT_EQ(same, name_of({{"program", {{"parameters", {{"mu", {{"unit", "-"}}}}}}}}));
    EXPECT_EQ(same, name_of({{"design", {{"points", 9}}}}));
    EXPECT_NE(same, name_of({{"fixed", {{"more", 1}}}}));
    EXPECT_NE(same, name_of({{"program", {{"command", {"python3", "run.py"}}}}}));
    EXPECT_NE(same, name_of({{"program", {{"observables", {{"flow", {{"from", {{"row", "last"}}}}}}}}}}));
    EXPECT_NE(same, name_of({{"program", {{"observables", {{"angle", {{"bounds", {0, 90}}}}}}}}}));
    beside.write("mesh/drum.stl", "another\n");
    EXPECT_NE(same, name_of({}));
}

}  // namespace grainsweep::tests::campaign_program_test
