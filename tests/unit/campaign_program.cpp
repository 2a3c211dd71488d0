// "program" of a campaign file: what is read, what is refused with which sentence, and what is identity.
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/output_pattern.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_changes.hpp"
#include "sweep/campaign/reader.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

namespace grainsweep::tests::campaign_program_test {

using namespace campaign;
using nlohmann::json;

namespace fs = std::filesystem;

/// A folder with some files to name.
struct Beside : Folder {
    Beside() {
        fs::create_directories(path() / "mesh");
        write("run.py", "print(1)\n");
        write("in.deck", "friction {{ mu }} seed {{seed31}}\n");
        write("mesh/drum.stl", "solid\n");
    }
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
    } catch (const InputError& wrong) {
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
        {{{"fixed", {{"True", 1}}}}, "is a number in SQL"},
        {{{"program", {{"observables", {{"false", {{"from", {{"output", "(x)"}}}}}}}}}}, "is a number in SQL"},
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
json file_with_settings() {
    auto file = sound_file();
    file["program"]["command"].push_back("{cells}");
    file["program"]["parameters"]["cells"] = {{"unit", "1"}, {"whole", true}, {"bounds", {1, 1000}}};
    file["program"]["accuracy"] = {{"coarse", {{"cells", 10}, {"cost_seconds", 0.5}}},
                                   {"fine", {{"cells", 80}, {"cost_seconds", 20}}},
                                   {"reference", "fine"}};
    return file;
}

TEST(ProgramAccuracy, SettingsGiveValuesAndCosts) {
    const Beside beside;
    auto file = file_with_settings();
    const auto by_default = parse_campaign(file.dump(), beside.path());
    EXPECT_EQ(by_default.space.fixed.at("cells"), Value{80.0}) << "the standard, because a setting has no default";
    file["accuracy"] = "coarse";
    const auto coarse = parse_campaign(file.dump(), beside.path());
    EXPECT_EQ(coarse.space.fixed.at("cells"), Value{10.0});
    EXPECT_EQ(coarse.scene().name, by_default.scene().name) << "a setting is inputs, not another program";
    EXPECT_EQ(coarse.scene().estimate_cost({{"cells", 10.0}}, {}).seconds, 0.5);
    EXPECT_EQ(coarse.scene().estimate_cost({{"cells", 80.0}}, {}).seconds, 20);
    EXPECT_EQ(coarse.scene().estimate_cost({{"cells", 20.0}}, {}).seconds, 1);
    file["fixed"]["cells"] = 40;
    EXPECT_EQ(parse_campaign(file.dump(), beside.path()).space.fixed.at("cells"), Value{40.0});
}

TEST(ProgramAccuracy, RefusesWithOneSentence) {
    const Beside beside;
    ASSERT_EQ(said_of(file_with_settings(), beside), "");
    struct Refused {
        json patch;
        std::string says;
    };
    const std::vector<Refused> all = {
        {{{"program", {{"accuracy", 1}}}}, "$.program.accuracy: got 1; must be an object of settings"},
        {{{"program", {{"accuracy", {{"coarse", 10}}}}}}, "$.program.accuracy.coarse: got 10; must be an object of"},
        {{{"program", {{"accuracy", {{"reference", nullptr}}}}}},
         "key 'reference' is missing: the name of the setting"},
        {{{"program", {{"accuracy", {{"reference", "fime"}}}}}}, "Did you mean 'fine'?"},
        {{{"program", {{"accuracy", {{"coarse", {{"cells", nullptr}}}}}}}}, "needs a parameter and its value"},
        {{{"program", {{"accuracy", {{"coarse", {{"cells", 10.5}}}}}}}}, "'cells' is a whole number"},
        {{{"program", {{"accuracy", {{"coarse", {{"cells", 5000}}}}}}}}, "'cells' must be a number from 1 to 1000"},
        {{{"program", {{"accuracy", {{"coarse", {{"step", 1}}}}}}}}, "$.program.accuracy.fine"},
        {{{"program", {{"accuracy", {{"coarse", {{"cost_seconds", 0}}}}}}}}, "a number above 0"},
        {{{"program", {{"processes", 0}}}}, "$.program.processes: got 0; must be a whole number from 1"},
        {{{"program", {{"processes", "two"}}}}, "$.program.processes"},
        {{{"program", {{"processes", 2}}}, {"fixed", {{"processes", 4}}}}, "{processes} would have two meanings"},
        {{{"program", {{"acuracy", 1}}}}, "Did you mean 'accuracy'?"},
        {{{"accuracy", "medium"}}, "$.accuracy: got \"medium\"; must be 'coarse', 'fine' or"},
    };
    for (const auto& [patch, says] : all) {
        json file = file_with_settings();
        file.merge_patch(patch);
        const auto said = said_of(file, beside);
        EXPECT_NE(said.find(says), std::string::npos) << patch << "\n  " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    json goal = file_with_settings();
    goal["program"]["accuracy"]["coarse"].erase("cost_seconds");
    goal["accuracy"] = {{"observable", "angle"}};
    EXPECT_NE(said_of(goal, beside).find("a goal needs \"cost_seconds\" in program.accuracy.coarse"),
              std::string::npos);
}

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
    EXPECT_NE(said({{"levels", {"a", "b"}}}, 4, true).find("levels[0]: got \"a\"; 'layers' must be a number"),
              std::string::npos)
        << said({{"levels", {"a", "b"}}}, 4, true);
}

TEST(ProgramSection, TemplatesNameWhatThereIs) {
    const Beside beside;
    beside.write("in.deck", "mu\n{{ mo }}\n");
    EXPECT_NE(said_of(sound_file(), beside).find("Did you mean 'mu'?"), std::string::npos);
    beside.write("in.deck", "mu\n{{ mu * 2 }}\n");
    EXPECT_NE(said_of(sound_file(), beside).find("line 2: '{{ mu * 2 }}' holds no name"), std::string::npos);
}

TEST(Placeholders, AreReplacedAndBracesStay) {
    const ValueOf value = [](std::string_view name, std::string_view format) -> std::optional<std::string> {
        if (name == "now") return std::nullopt;
        return fmt::format("<{}{}>", name, format);
    };
    EXPECT_EQ(filled_command("a{x}b {y_1}", value), "a<x>b <y_1>");
    EXPECT_EQ(filled_command("{{x}} {} { x } {1} {a-b} }{ {", value), "{x} {} { x } {1} {a-b} }{ {");
    EXPECT_EQ(filled_command("{x:%.3e} {{x:%.3e}} {x:.3f} {now:%H:%M}", value), "<x%.3e> {x:%.3e} {x:.3f} {now:%H:%M}");
    EXPECT_EQ(filled_template("a {{ x }}{{y}}\n{x} {{\n}} {{", value), "a <x><y>\n{x} {{\n}} {{");
    EXPECT_EQ(filled_template("{{ x:%.3e }} {{x : %d}}", value), "<x%.3e> <x%d>");
    EXPECT_THROW((void)filled_template("{{}}", value), std::invalid_argument);
    EXPECT_THROW((void)filled_template("{{ x:.3f }}", value), std::invalid_argument);
}

TEST(Placeholders, FormatsAreThoseOfC) {
    for (const char* text :
         {"%.3e", "%12.4f", "%-12.4f", "%+.2E", "%g", "%010.3f", "% .1f", "%#.0f", "%G", "%.0e", "%.10g"}) {
        for (const double x : {0.0, 1.5, -2.25e-7, 123456789.125, 1e300}) {
            std::array<char, 512> expected{};
            std::snprintf(expected.data(), expected.size(), text, x);  // NOLINT
            const auto format = NumberFormat::parse(text);
            ASSERT_TRUE(format) << text;
            EXPECT_EQ((*format)(x), expected.data()) << text << ' ' << x;
            EXPECT_FALSE(format->is_whole());
        }
    }
    EXPECT_EQ((*NumberFormat::parse("%05d"))(42.0), "00042");
    EXPECT_EQ((*NumberFormat::parse("%d"))(std::uint64_t{1} << 40U), "1099511627776");
    EXPECT_TRUE(NumberFormat::parse("%d")->is_whole());
    for (const char* text : {"", "%", "%s", "%n", "%.3", "%.3ex", "3e", "%.999e", "%99999f", "%.2d", "%lf", "%H:%M"})
        EXPECT_FALSE(NumberFormat::parse(text)) << text;
}

TEST(Placeholders, APrimeOfTheSeedIsOne) {
    std::set<std::uint64_t> all;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const auto prime = prime_of(seed * 0x9E3779B97F4A7C15U);
        EXPECT_GT(prime, 10'000U);
        EXPECT_LE(prime, 0x7FFF'FFFFU);
        for (std::uint64_t d = 2; d * d <= prime; ++d) ASSERT_NE(prime % d, 0U) << prime;
        all.insert(prime);
    }
    EXPECT_GT(all.size(), 198U);
    EXPECT_EQ(prime_of(0), 10'007U);
    EXPECT_EQ(prime_of(0x7FFF'FFFF - 10'007), 0x7FFF'FFFFU) << "the largest";
}

TEST(Placeholders, NumbersAreShownForPrograms) {
    EXPECT_EQ(program_value(Value{1e6}), "1000000");
    EXPECT_EQ(program_value(Value{-3.0}), "-3");
    EXPECT_EQ(program_value(Value{0.1}), "0.1");
    EXPECT_EQ(program_value(Value{1e300}), "1e+300");
    EXPECT_EQ(program_value(Value{std::string("jkr")}), "jkr");
    EXPECT_EQ(program_value(Value{2e-3}, "%.3e"), "2.000e-03");
    EXPECT_EQ(program_value(Value{7.0}, "%d"), "7");
    EXPECT_EQ(json::parse(program_question("id", 7, 2, {{"a", 1e6}, {"b", std::string("\"q\" \xC3\xA4")}})),
              json::parse(R"({"case": "id", "seed": 7, "threads": 2, "inputs": {"a": 1000000, "b": "\"q\" \u00e4"}})"));
}

/// A campaign over gap with a length, whose parameters are as given.
struct Quantity {
    json file(const json& parameters, const json& fixed, const json& factor = {{"name", "gap"}, {"between", {1, 3}}}) {
        json campaign = json::parse(R"json({"campaign": "c", "scene": "program",
          "program": {"command": ["sh", "run.py", "{gap}"], "files": ["run.py"],
                      "observables": {"y": {"from": {"output": "y = (.*)"}}}},
          "design": {"kind": "lattice", "levels": [3]}})json");
        campaign["program"]["parameters"] = parameters;
        campaign["factors"] = {factor};
        campaign["fixed"] = fixed;
        return campaign;
    }
    Campaign read(const json& campaign) { return parse_campaign(campaign.dump(), beside.path()); }
    std::string said(const json& campaign) { return said_of(campaign, beside); }
    /// Inputs of the middle of the range.
    Inputs middle(const json& campaign) {
        const auto read_one = read(campaign);
        const std::vector<double> u(read_one.space.factors.size(), 0.5);
        return read_one.space.at(u);
    }
    const Beside beside;
};

TEST(ProgramQuantities, ReachTheProgramInTheUnitOfTheParameter) {
    Quantity of;
    const json gap = {{"gap", {{"unit", "mm"}, {"bounds", {"0.1 mm", "1 cm"}}}}};
    json units = gap;
    units["length"] = {{"unit", "mm"}};
    auto inputs = of.middle(of.file(units, {{"length", "2 cm"}}, {{"name", "gap"}, {"between", {"1000 um", 3}}}));
    EXPECT_EQ(inputs["gap"], Value{2.0});
    EXPECT_EQ(inputs["length"], Value{20.0});
    inputs = of.middle(of.file(units, {{"length", "2*gap + 1"}}));
    EXPECT_EQ(inputs["length"], Value{5.0});
    inputs = of.middle(of.file(gap, json::object(), {{"name", "gap"}, {"levels", {"1 mm", "0.2 cm", 3}}}));
    EXPECT_EQ(inputs["gap"], Value{2.0});
    auto listed = of.file(gap, json::object());
    listed["design"] = {{"kind", "list"}, {"rows", {{"2500 um"}}}};
    const auto campaign = of.read(listed);
    EXPECT_EQ(std::get<designs::Rows>(campaign.request.options.at("rows"))[0][0], Value{2.5});
}

TEST(ProgramQuantities, ExpressionsLinkParameters) {
    Quantity of;
    const json si = {{"gap", {{"unit", "m"}}}, {"area", {{"unit", "m2"}}}, {"n", {{"whole", true}}}};
    const auto inputs = of.middle(of.file(si, {{"area", "n*gap^2"}, {"n", "2*3"}}));
    EXPECT_EQ(inputs.at("area"), Value{24.0});
    EXPECT_EQ(inputs.at("n"), Value{6.0});
    const json mixed = {{"gap", {{"unit", "mm"}}}, {"length", {{"unit", "m"}}}};
    EXPECT_NE(of.said(of.file(mixed, {{"length", "2*gap"}}))
                  .find("$.fixed.length: got \"2*gap\"; an expression takes the numbers as they are, and gap is in mm, "
                        "length is in m"),
              std::string::npos)
        << of.said(of.file(mixed, {{"length", "2*gap"}}));
    EXPECT_NE(of.said(of.file(si, {{"area", "2*gop"}, {"n", 2}})).find("the nearest is 'gap'"), std::string::npos)
        << of.said(of.file(si, {{"area", "2*gop"}, {"n", 2}}));
    const auto of_word = of.said(of.file(si, {{"area", "if(tool == 1, 2, 3)*gap"}, {"n", 2}, {"tool", "blade"}}));
    EXPECT_NE(of_word.find("the values of tool are words, and expressions are of numbers"), std::string::npos)
        << of_word;
    const auto half = of.read(of.file({{"gap", {{"unit", "1"}}}, {"n", {{"whole", true}}}}, {{"n", "gap/2 + 0.25"}}));
    try {
        const std::vector<double> u = {0.5};
        check_expressions(half.space, half.space.at(u));
        FAIL() << "1.25 is no whole number";
    } catch (const InputError& wrong) {
        EXPECT_NE(std::string(wrong.what()).find("'n' must be a whole number, and it is 1.25 where gap = 2"),
                  std::string::npos)
            << wrong.what();
    }
}

TEST(ProgramQuantities, TextsForNumbersWithoutUnitAreRefused) {
    Quantity of;
    const auto expect = [&](const json& campaign, const std::string& part) {
        EXPECT_NE(of.said(campaign).find(part), std::string::npos) << of.said(campaign);
        EXPECT_EQ(of.said(campaign).find('\n'), std::string::npos);
    };
    const json none = json::object();
    expect(of.file(none, {{"radius", "2 mm"}}),
           "$.fixed.radius: got \"2 mm\"; is a number with a unit, and 'radius' has no unit: state \"unit\" in "
           "program.parameters.radius, or \"bounds\": [\"2 mm\"] if it is a word");
    expect(of.file(none, {{"length", "2*gap"}}),
           "$.fixed.length: got \"2*gap\"; is an expression of other parameters, and 'length' has no unit");
    expect(of.file({{"radius", {{"bounds", {1e-4, 1e-2}}}}}, {{"radius", "2 mm"}}), "$.fixed.radius: got \"2 mm\"");
    expect(of.file({{"radius", {{"whole", true}}}}, {{"radius", "2 mm"}}),
           "the parameter has no unit, and 'mm' is one");
    expect(of.file({{"radius", {{"unit", "m"}}}}, {{"radius", "2 kg"}}), "'kg' does not fit 'm'");
    expect(of.file({{"radius", {{"unit", "m"}, {"bounds", {1e-4, 1e-2}}}}}, {{"radius", "2 m"}}),
           "$.fixed.radius: got \"2 m\"; 'radius' must be a number from 1e-04 to 0.01 m, and this is 2 m");
    expect(of.file({{"radius", {{"unit", "m"}, {"bounds", {"0.1 kg", "1 mm"}}}}}, {{"radius", 1e-3}}),
           "$.program.parameters.radius.bounds");
    expect(of.file(none, none, {{"name", "gap"}, {"levels", {1, "2 mm"}}}), "$.factors[0].levels[1]: got \"2 mm\"");
    expect(of.file(none, none, {{"name", "gap"}, {"levels", {1, "jkr"}}}), "all numbers or all words");
    expect(of.file({{"gap", {{"bounds", {"a", "b"}}}}}, none, {{"name", "gap"}, {"levels", {1, "a"}}}),
           "all numbers or all words, and the bounds of 'gap' are words");
    // Words stay words.
    for (const char* word : {"jkr", "3d", "2D", "1st", "gap", "coarse-2", "v1.2", "60"})
        EXPECT_EQ(of.said(of.file(none, {{"mode", word}})), "") << word;
    EXPECT_EQ(of.middle(of.file({{"mode", {{"bounds", {"60 um"}}}}}, {{"mode", "60 um"}})).at("mode"),
              Value{std::string("60 um")});
}

TEST(ProgramQuantities, AConditionThatIsFalseSendsTheDefault) {
    Quantity of;
    const json conditional = {{"name", "gap"}, {"between", {1, 3}}, {"when", "tool = 'b'"}};
    const json fixed = {{"tool", "b"}};
    const auto standard = [&](const json& parameter) {
        return of.read(of.file({{"gap", parameter}}, fixed, conditional)).scene().find_parameter("gap")->default_value;
    };
    EXPECT_EQ(standard({{"unit", "mm"}}), Value{0.0});
    EXPECT_EQ(standard({{"unit", "mm"}, {"default", "1 cm"}}), Value{10.0});
    const auto name = [&](const json& parameter) {
        return of.read(of.file({{"gap", parameter}}, fixed, conditional)).scene().name;
    };
    EXPECT_EQ(name({{"unit", "mm"}}), name({{"unit", "mm"}, {"default", 0}}));
    EXPECT_NE(name({{"unit", "mm"}}), name({{"unit", "mm"}, {"default", 1}})) << "it changes answers";
    EXPECT_NE(of.said(of.file({{"gap", {{"default", 1}}}}, json::object())).find("has no effect: 'gap' is no factor"),
              std::string::npos);
    const auto campaign = of.read(of.file({{"gap", {{"default", 2.5}, {"unit", "mm"}}}}, fixed, conditional));
    const auto again = program_in(program_text(*known_program(campaign.scene().name)));
    EXPECT_EQ(again.parameters[0].standard, Value{2.5});
    EXPECT_EQ(program_scene_name(again), campaign.scene().name);
}

TEST(ProgramQuantities, ANumberThatIsSentHasItsBounds) {
    Quantity of;
    const json conditional = {{"name", "gap"}, {"between", {1, 3}}, {"when", "tool = 'b'"}};
    const auto said = [&](const json& gap) { return of.said(of.file({{"gap", gap}}, {{"tool", "b"}}, conditional)); };
    EXPECT_NE(said({{"bounds", {1, 3}}})
                  .find("$.program.parameters.gap.bounds: got [1,3]; 0 lies outside, and 'gap' "
                        "is 0 where its \"when\" is false: state \"default\""),
              std::string::npos)
        << said({{"bounds", {1, 3}}});
    EXPECT_EQ(said({{"bounds", {1, 3}}, {"default", 1}}), "");
    EXPECT_EQ(said({{"bounds", {0, 3}}}), "");
    const auto undefined = of.read(of.file({{"gap", {{"unit", "1"}}}, {"n", {{"unit", "1"}}}}, {{"n", "1/(gap-2)"}}));
    try {
        const std::vector<double> u = {0.5};
        check_expressions(undefined.space, undefined.space.at(u));
        FAIL() << "1/0 is no number";
    } catch (const InputError& wrong) {
        EXPECT_NE(std::string(wrong.what()).find("where gap = 2"), std::string::npos) << wrong.what();
    }
}

TEST(ProgramQuantities, FunctionsOfAnglesTakeRadians) {
    Quantity of;
    const auto said = [&](const std::string& expression, const std::string& unit = "deg") {
        return of.said(of.file({{"gap", {{"unit", unit}}}, {"slope", {{"unit", "1"}}}}, {{"slope", expression}}));
    };
    EXPECT_NE(said("tan(gap)")
                  .find("$.fixed.slope: got \"tan(gap)\"; sin, cos, tan and atan2 are of radians, and gap "
                        "is in deg: write gap*pi/180"),
              std::string::npos)
        << said("tan(gap)");
    EXPECT_NE(said("1 + 2*sin(gap)"), "");
    for (const char* sound : {"tan(gap*pi/180)", "sin(gap/57.29578)", "2*gap"}) EXPECT_EQ(said(sound), "") << sound;
    EXPECT_EQ(said("tan(gap)", "rad"), "");
    EXPECT_EQ(said("sin(gap)", "1"), "");
    const auto pitched = of.file({{"gap", {{"unit", "deg"}}}, {"slope", {{"unit", "1"}}}, {"pitch", {{"unit", "1"}}}},
                                 {{"slope", "pitch*tan(gap)"}, {"pitch", 2}});
    EXPECT_NE(of.said(pitched).find("write gap*pi/180"), std::string::npos) << "pi is no part of a name";
}

TEST(ProgramQuantities, FormatsAreCheckedWhereTheyStand) {
    Quantity of;
    const auto with = [&](const std::string& argument, const json& gap = {{"unit", "m"}}) {
        auto file = of.file({{"gap", gap}}, {{"mode", "jkr"}});
        file["program"]["command"][2] = argument;
        return of.said(file);
    };
    for (const char* sound : {"{gap:%.3e}", "{gap:%g}", "{seed31:%010d}", "{seed_prime}", "f'{now:%H:%M}'", "{x:.3f}"})
        EXPECT_EQ(with(sound), "") << sound;
    EXPECT_NE(with("{gap:%d}").find("%d is for whole numbers"), std::string::npos) << with("{gap:%d}");
    EXPECT_NE(with("{gap:%q}").find("$.program.command[2]: got {gap:%q}; is no format of a number"), std::string::npos);
    EXPECT_NE(with("{mode:%.3e}").find("the values of 'mode' are words"), std::string::npos);
    EXPECT_NE(with("{gpa:%.3e}").find("Did you mean 'gap'?"), std::string::npos);
}

/// Warnings are for ranges that may be counts by mistake.
TEST(ProgramQuantities, WarningsAreNotFalse) {
    Quantity of;
    const auto warned = [&](const json& parameter, const json& more = json::object()) {
        json factor = {{"name", "gap"}, {"between", {1, 10}}};
        factor.update(more);
        const auto campaign = of.read(of.file({{"gap", parameter}}, json::object(), factor));
        const auto warnings = warnings_of(campaign, {});
        return std::ranges::any_of(
            warnings, [](const auto& warning) { return warning.find("takes every real number") != std::string::npos; });
    };
    EXPECT_TRUE(warned(json::object()));
    EXPECT_FALSE(warned({{"unit", "1"}}));
    EXPECT_FALSE(warned({{"unit", "mm"}}));
    EXPECT_FALSE(warned({{"whole", true}}, {{"whole", true}}));
    EXPECT_FALSE(warned(json::object(), {{"step", 1}}));
}

TEST(ProgramChanges, AreNamed) {
    const Beside beside;
    const auto program = [&](const json& patch) {
        json file = sound_file();
        if (patch.is_object()) file.merge_patch(patch);
        return known_program(parse_campaign(file.dump(), beside.path()).scene().name);
    };
    const auto before = program({});
    const auto only = [&](const json& patch) {
        const auto changes = program_changes(*before, *program(patch));
        EXPECT_EQ(changes.size(), 1U) << patch;
        return changes.at(0);
    };
    using Kind = ProgramChange::Kind;
    EXPECT_TRUE(program_changes(*before, *program({{"program", {{"cores", 1}}}})).empty());
    auto change = only({{"program", {{"command", {"/opt/bin/python3", "run.py", "-mu={mu}", "{{mu}}"}}}}});
    EXPECT_EQ(change.line(), "$.program.command[0]: python3 -> /opt/bin/python3");
    EXPECT_EQ(change.kind, Kind::adoptable);
    change = only({{"program", {{"command", {"python3", "run.py", "-nu={mu}", "{{mu}}"}}}}});
    EXPECT_EQ(change.line(), "$.program.command[2]: -mu={mu} -> -nu={mu}");
    EXPECT_EQ(change.kind, Kind::another_program);
    change = only({{"program", {{"environment", {{"A", "1"}}}}}});
    EXPECT_EQ(change.place, "$.program.environment.A");
    change = only({{"program", {{"observables", {{"more", {{"from", {{"output", "(x)"}}}}}}}}}});
    EXPECT_EQ(change.kind, Kind::further_observable);
    change = only({{"program", {{"observables", {{"energy", {{"from", {{"output", "(x)"}}}}}}}}}});
    EXPECT_EQ(change.kind, Kind::another_program);
    change = only({{"fixed", {{"more", 1}}}});
    EXPECT_EQ(change.line(), "more: new");
    EXPECT_EQ(change.kind, Kind::another_program);
    change = only({{"program", {{"does_not_count", {"mesh/drum.stl"}}}}});
    EXPECT_EQ(change.line(), "mesh/drum.stl: counts -> does not count");
    EXPECT_EQ(change.kind, Kind::adoptable);
    beside.write("in.deck", "friction {{ mu }} seed {{ seed31 }}\n");
    change = only({});
    EXPECT_EQ(change.place, "$.program.templates");
    EXPECT_EQ(change.name, "in.deck");
    EXPECT_EQ(change.kind, Kind::adoptable);
    try {
        refuse_changed_program("c", "c.db", {change});
    } catch (const InputError& wrong) {
        const std::string said = wrong.what();
        EXPECT_NE(said.find("$.program.templates: in.deck changed since 'c.db' ("), std::string::npos) << said;
        EXPECT_NE(said.find("give the campaign a new name, which computes every case, or a new name and --adopt c"),
                  std::string::npos)
            << said;
    }
}

/// The contents of a file that does not count change no id, and stay with the definition.
TEST(ProgramSection, FilesMayNotCount) {
    const Beside beside;
    const auto read = [&](const json& names) {
        json file = sound_file();
        file["program"]["does_not_count"] = names;
        return parse_campaign(file.dump(), beside.path()).scene().name;
    };
    const auto same = read({"run.py"});
    EXPECT_NE(same, read(json::array()));
    beside.write("run.py", "print(2)\n");
    EXPECT_EQ(same, read({"run.py"}));
    const auto program = known_program(same);
    const auto again = program_in(program_text(*program));
    EXPECT_EQ(program_scene_name(again), same);
    EXPECT_EQ(again.files.size(), program->files.size());
    json file = sound_file();
    file["program"]["does_not_count"] = {"run.pi"};
    EXPECT_NE(said_of(file, beside).find("Did you mean 'run.py'?"), std::string::npos) << said_of(file, beside);
}

/// Ids of campaigns that were stored before parameters took units: hashes by version 0.2.0.
TEST(ProgramSection, OldCampaignsKeepTheirIds) {
    const Beside beside;
    const auto campaign = parse_campaign(sound_file().dump(), beside.path());
    EXPECT_EQ(campaign.scene().name, "program:503f78b6f1fdb2e55e8af5681e429eca");
    const auto cases = unfold(campaign, [](const Inputs&) { return true; });
    EXPECT_EQ(cases.id(0), "a8af814546675c2920585221fddd9baf");
    EXPECT_EQ(cases.id(3), "05e757e38700840523f93790de9ae660");
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
    EXPECT_EQ(same, name_of({{"program", {{"observables", {{"angle", {{"optional", false}}}}}}}}));
    EXPECT_NE(same, name_of({{"program", {{"observables", {{"angle", {{"optional", true}}}}}}}}));
    beside.write("mesh/drum.stl", "another\n");
    EXPECT_NE(same, name_of({}));
}

}  // namespace grainsweep::tests::campaign_program_test
