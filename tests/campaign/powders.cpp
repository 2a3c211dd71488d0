// Powders through the real program: an instrument's export becomes sizes, a powder file a scene's parameters, and a
// database alone explains and replays what was computed with them.
#include "tests/support/commands.hpp"
#include "tests/support/machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::powders_test {

using nlohmann::json;
using testing::HasSubstr;

namespace fs = std::filesystem;

constexpr const char* instrument_export =
    "Probe;Ti64 Charge 7\nVerteilungsart;Volumen\n\nx [\xB5m];Q3 "
    "[%]\n15,0;0,0\n20,0;10,0\n27,5;30,2\n34,0;50,0\n41,0;70,1\n"
    "52,0;90,0\n63,0;99,8\n\nEnde der Messung;14:02\n";

/// A blade one unit thick and high, as long as no layer here is wide, x along the travel, z up.
std::string blade_as_stl() {
    const auto facet = [](const char* a, const char* b, const char* c) {
        return std::string("facet normal 0 0 0\nouter loop\nvertex ") + a + "\nvertex " + b + "\nvertex " + c +
               "\nendloop\nendfacet\n";
    };
    const auto face = [&](const char* a, const char* b, const char* c, const char* d) {
        return facet(a, b, c) + facet(a, c, d);
    };
    return "solid blade\n" + face("0 0 0", "0 9 0", "1 9 0", "1 0 0") + face("0 0 1", "1 0 1", "1 9 1", "0 9 1") +
           face("0 0 0", "1 0 0", "1 0 1", "0 0 1") + face("0 9 0", "0 9 1", "1 9 1", "1 9 0") +
           face("0 0 0", "0 0 1", "0 9 1", "0 9 0") + face("1 0 0", "1 9 0", "1 9 1", "1 0 1") + "endsolid blade\n";
}

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

json ti64() {
    return json::parse(R"({"powder": "ti64", "notes": "gas atomised",
        "material": {"density": "4430 kg/m3", "youngs_modulus": "10 MPa", "poisson_ratio": 0.34},
        "sizes": {"file": "sizes.csv"}, "cut": {"below": "20 um"},
        "contacts": {"friction": 0.4, "restitution": 0.6, "cohesion_law": "dmt", "surface_energy": "0.01 mJ/m2",
                     "cohesion": 0, "wall_friction": 0.3},
        "measured": [{"what": "angle of repose", "value": "34 deg", "error": "1.5 deg", "how": "ISO 4324"}]})");
}

struct Powders : CommandsInAFolder {
    void SetUp() override {
        folder.write("export.csv", instrument_export);
        folder.write("blade.stl", blade_as_stl());
        folder.write("ti64.json", ti64().dump(1));
    }
    void import_sizes() const { out({"powder", "import", "export.csv", "-o", "sizes.csv"}); }
    json plan(const json& campaign) const {
        folder.write("c.json", campaign.dump(1));
        return json::parse(out({"plan", "c.json", "--format", "json"}));
    }
};

/// Spreading of a fine powder, lengths in grains, from files only.
json spreading() {
    return json::parse(R"json({"campaign": "ti", "scene": "powder_spreading", "powder": "ti64.json",
        "factors": [{"name": "speed", "between": ["50 mm/s", "250 mm/s"]}],
        "fixed": {"tool": "blade.stl", "tool_scale": "0.1 mm", "gap": "60 um", "settle_time": "10 ms",
                  "travel": "30*diameter", "layer_beyond": "10*diameter",
                  "layer_area": "0.55*3*gap*(travel + layer_beyond)"},
        "accuracy": "fast", "design": {"kind": "halton", "points": 2}})json");
}

json drum() {
    return json::parse(R"({"campaign": "d", "scene": "rotating_drum", "powder": "ti64.json",
        "factors": [{"name": "rpm", "between": [10, 30]}],
        "fixed": {"drum_diameter": "30*diameter", "length": "6*diameter", "particles": 500},
        "design": {"kind": "halton", "points": 2}})");
}

TEST_F(Powders, AreImportedFromAnExport) {
    const auto said = json::parse(out({"powder", "import", "export.csv", "-o", "sizes.csv", "--format", "json"}));
    EXPECT_THAT(said["sentence"].get<std::string>(), HasSubstr("7 sizes from 15 um to 63 um, by volume"));
    EXPECT_EQ(said["taken"]["text"], "Latin-1");
    EXPECT_EQ(said["taken"]["columns apart by"], "semicolons, decimal commas");
    EXPECT_EQ(said["notes"].size(), 1U);
    EXPECT_THAT(text_of(folder / "sizes.csv"), HasSubstr("diameter,volume_below\n1.5e-05,0\n2e-05,0.1002"));
    EXPECT_THAT(out({"powder", "import", "export.csv", "-o", "sizes.csv"}),
                HasSubstr("note: the shares end at 99.8 %"));

    folder.write("open.csv", "Size,Volume Under %\n1,0\n2,100\n");
    const auto refused = ask({"powder", "import", "open.csv", "-o", "open_sizes.csv"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("give it by --unit"));
    EXPECT_FALSE(fs::exists(folder.path() / "open_sizes.csv"));
    out({"powder", "import", "open.csv", "-o", "open_sizes.csv", "--unit", "um"});
    EXPECT_EQ(text_of(folder / "open_sizes.csv"), "diameter,volume_below\n1e-06,0\n2e-06,1\n");
}

TEST_F(Powders, AreShown) {
    import_sizes();
    const auto values = json::parse(out({"powder", "show", "ti64.json", "--format", "json"}))["values"];
    EXPECT_NEAR(values["mass cut off below"].get<double>(), 0.1 / 0.998, 1e-6);
    EXPECT_EQ(values["mass cut off above"], 0);
    EXPECT_NEAR(values["smallest"].get<double>(), 20e-6, 1e-15);
    EXPECT_LT(values["d50 by number"].get<double>(), values["d50 by volume"].get<double>());
    // DMT: pi w R over the weight of the diameter that stands for the powder.
    const double diameter = values["diameter that stands for it"];
    const double weight = 4430 * 3.14159265358979 / 6 * diameter * diameter * diameter * 9.81;
    EXPECT_NEAR(values["bond number"].get<double>(), 3.14159265358979 * 1e-5 * diameter / 2 / weight, 1e-6);
    EXPECT_THAT(out({"powder", "show", "ti64.json"}), HasSubstr("####"));
}

TEST_F(Powders, SetTheParametersOfScenes) {
    import_sizes();
    const auto planned = plan(drum());
    EXPECT_EQ(planned["fixed"]["density"], 4430);
    EXPECT_EQ(planned["fixed"]["surface_energy"], 1e-5);
    EXPECT_EQ(planned["fixed"]["size_distribution"], "file");
    EXPECT_THAT(planned["fixed"]["size_file"].get<std::string>(), HasSubstr("ti64.json sizes"));
    EXPECT_FALSE(planned["fixed"].contains("cohesion"));  // without effect beside dmt
    EXPECT_THAT(planned["powder"].get<std::string>(), HasSubstr("ti64 (ti64.json) sets density, "));

    auto own = drum();
    own["fixed"]["friction"] = 0.7;
    own["factors"].push_back({{"name", "density"}, {"levels", {2500, 4430}}});
    const auto overridden = plan(own);
    EXPECT_EQ(overridden["fixed"]["friction"], 0.7);
    EXPECT_THAT(overridden["powder"].get<std::string>(), HasSubstr("the campaign itself gives density, friction"));

    auto tpms = json::parse(R"({"campaign": "t", "scene": "tpms_discharge", "powder": "ti64.json",
        "factors": [{"name": "tilt", "levels": [0, 10]}], "fixed": {"edge": 10, "time_step": 1e-7},
        "design": {"kind": "lattice", "levels": 2}})");
    EXPECT_THAT(plan(tpms)["powder"].get<std::string>(), HasSubstr("has no place for sizes beside their d50"));
    EXPECT_THAT(out({"plan", "c.json"}), HasSubstr("powder     ti64 (ti64.json) sets"));
}

TEST_F(Powders, AskTheSameAsParametersByHand) {
    auto powder =
        json::parse(R"({"powder": "beads", "material": {"density": "2.5 g/cm3"}, "sizes": {"diameter": "3 mm"},
                                  "contacts": {"friction": 0.45}})");
    folder.write("ti64.json", powder.dump());
    auto by_hand = drum();
    by_hand.erase("powder");
    by_hand["fixed"].update({{"density", 2500}, {"diameter", 0.003}, {"friction", 0.45}});
    const auto ids = [](const json& planned) {
        return json{planned["rows"][0]["case_id"], planned["rows"][1]["case_id"]};
    };
    EXPECT_EQ(ids(plan(drum())), ids(plan(by_hand)));
}

TEST_F(Powders, AreSpeciesOfMachines) {
    folder.write("beads.json", R"({"powder": "beads", "material": {"density": "2.5 g/cm3", "youngs_modulus": "5 MPa",
        "poisson_ratio": 0.25}, "sizes": {"d10": "2.6 mm", "d50": "3 mm", "d90": "3.4 mm"},
        "contacts": {"friction": 0.35, "wall_friction": 0.2}})");
    auto machine = small_machine();
    machine["materials"].erase("glass");
    machine["materials"]["steel"].erase("density");
    machine["walls"]["lid"]["material"] = "steel";
    machine["species"] = {{"light", {{"powder", "beads.json"}}},
                          {"heavy", {{"material", "light"}, {"diameter", "2.5 mm"}}}};
    machine["contacts"] = {{"restitution", 0.5}};
    folder.write("bin.json", machine.dump());
    folder.write("c.json", json{{"campaign", "m"},
                                {"scene", "machine"},
                                {"machine", "bin.json"},
                                {"factors", {{{"name", "speed"}, {"levels", {30, 90}}}}},
                                {"design", {{"kind", "lattice"}, {"levels", 2}}}}
                               .dump());
    const auto planned = json::parse(out({"plan", "c.json", "--format", "json"}));
    // The same machine with everything written out, but for its sizes, which a file gives.
    out({"run", "c.json", "--db", "m.db", "--quiet"});
    const auto stored = json::parse(out({"query", "m.db", "SELECT definition FROM machine", "--format", "json"}));
    const auto written = json::parse(stored[0]["definition"].get<std::string>())["machine"];
    EXPECT_EQ(written["materials"]["light"]["density"], "2.5 g/cm3");
    EXPECT_EQ(written["contacts"]["pairs"]["light light"]["friction"], 0.35);
    EXPECT_EQ(written["contacts"]["pairs"]["light steel"]["friction"], 0.2);
    EXPECT_EQ(written["species"]["light"]["sizes"]["file"], "beads.json sizes");
    EXPECT_EQ(written["species"]["light"]["diameter"], 0.003);
    fs::remove(folder / "beads.json");
    EXPECT_TRUE(json::parse(out({"replay", "m.db", planned["rows"][0]["case_id"], "--format", "json"}))["agrees"]);
}

TEST_F(Powders, RefuseWhatIsWrongInOneSentence) {
    import_sizes();
    const auto refusal = [&](const json& powder, const json& campaign = drum()) {
        folder.write("ti64.json", powder.dump());
        folder.write("c.json", campaign.dump());
        const auto ended = ask({"plan", "c.json"});
        EXPECT_EQ(ended.code, 2) << ended.out;
        return ended.err;
    };
    auto changed = [&](const std::string& pointer, const json& value) {
        auto powder = ti64();
        powder[json::json_pointer(pointer)] = value;
        return powder;
    };
    EXPECT_THAT(refusal(changed("/material/density", "4430 um")), HasSubstr("ti64.json: $.material.density"));
    EXPECT_THAT(refusal(changed("/material/densty", 4430)), HasSubstr("Did you mean 'density'?"));
    EXPECT_THAT(refusal(changed("/contacts/cohesion_law", "jkrs")), HasSubstr("Did you mean 'jkr'?"));
    EXPECT_THAT(refusal(changed("/sizes/d50", "34 um")), HasSubstr("sizes are given by one of"));
    EXPECT_THAT(refusal(changed("/cut/below", "80 um")), HasSubstr("none lies between"));
    EXPECT_THAT(refusal(changed("/sizes/file", "export.csv")), HasSubstr("powder import"));
    EXPECT_THAT(refusal(changed("/posterior", "none.csv")), HasSubstr("the file 'none.csv' beside it cannot be read"));
    auto elsewhere = drum();
    elsewhere["powder"] = "ti46.json";
    EXPECT_THAT(refusal(ti64(), elsewhere), HasSubstr("Did you mean 'ti64.json'?"));
    auto rehearsal = json::parse(R"({"campaign": "r", "scene": "rehearsal", "powder": "ti64.json",
        "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 2}})");
    EXPECT_THAT(refusal(ti64(), rehearsal), HasSubstr("has no parameter that powder 'ti64' gives"));
}

TEST_F(Powders, AreSpreadFromFilesAndReplayedFromTheDatabaseAlone) {
    import_sizes();
    folder.write("ti.json", spreading().dump(1));
    out({"run", "ti.json", "-j", "2", "--quiet"});
    EXPECT_THAT(out({"query", "ti.db", "SELECT count(*) FROM ti WHERE outcome = 'completed'", "--format", "csv"}),
                HasSubstr("\n2\n"));
    const Folder empty(in_memory());
    fs::rename(folder.path() / "ti.db", empty.path() / "ti.db");
    for (const auto& entry : fs::directory_iterator(folder.path())) fs::remove_all(entry.path());
    const auto say = [&](const std::vector<std::string>& arguments) {
        const auto ended = run_program(arguments, empty.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended.out;
    };
    const auto id = json::parse(say({"query", "ti.db", "SELECT case_id FROM ti WHERE point = 1", "--format", "json"}));
    const std::string name = id[0]["case_id"];
    EXPECT_TRUE(json::parse(say({"replay", "ti.db", name, "--format", "json"}))["agrees"]);
    const auto explained = json::parse(say({"explain", "ti.db", name, "--format", "json"}));
    std::vector<std::string> names;
    for (const auto& file : explained["files"]) names.push_back(file["file"]);
    EXPECT_THAT(names, testing::UnorderedElementsAre("blade.stl", "ti64.json", "sizes.csv", "ti64.json sizes"));
    EXPECT_THAT(say({"verify", "ti.db"}), HasSubstr("nothing is damaged"));
}

/// Two conditions that leave a ridge of x1 with x2, at x1 = 0.3 and x2 = 0.6.
const char* const calibration = R"({"campaign": "cal", "scene": "rehearsal",
    "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
    "fixed": {"response": "spreading_a", "x4": 0.5, "noise": 0.02},
    "calibration": {"targets": [{"observable": "y", "value": 0.2370, "error": 0.003, "inputs": {"x3": 0.5}},
                                {"observable": "y", "value": 0.4949, "error": 0.003, "inputs": {"x3": 0.95}}],
                    "discrepancy": {"y": 0.001}, "waves": 3, "points_per_wave": 24, "checks": 2}})";

TEST_F(Powders, AreNoiseAsFarAsACalibrationKnowsThem) {
    folder.write("cal.json", calibration);
    out({"calibrate", "cal.json", "--quiet"});
    folder.write("known.json", R"({"powder": "known", "posterior": "cal_posterior.csv"})");
    folder.write("layer.json", R"({"campaign": "layer", "scene": "rehearsal",
        "factors": [{"name": "x3", "between": [0.3, 1]},
                    {"name": "x1", "sample": {"powder": "known.json"}, "role": "noise"},
                    {"name": "x2", "sample": {"powder": "known.json"}, "role": "noise"}],
        "fixed": {"response": "spreading_a", "x4": 0.5, "noise": 0.02}, "design": {"kind": "halton", "points": 64}})");
    EXPECT_THAT(out({"plan", "layer.json"}), HasSubstr("column 1 of 2 of a sample of"));
    out({"run", "layer.json", "--quiet"});
    const auto window =
        json::parse(out({"window", "layer.db", "--where", "y <= 0.4", "--maximize", "x3", "--format", "json"}));
    const double gap = window["best"]["inputs"]["x3"];
    EXPECT_GE(window["best"]["probability"].get<double>(), 0.95);
    EXPECT_GT(gap, 0.55);  // y = 0.4 at 0.697, where the powder is known
    folder.write("truth.json", json{{"campaign", "truth"},
                                    {"scene", "rehearsal"},
                                    {"factors", {{{"name", "x3"}, {"levels", {gap}}}}},
                                    {"fixed", {{"response", "spreading_a"}, {"x1", 0.3}, {"x2", 0.6}, {"x4", 0.5}}},
                                    {"design", {{"kind", "lattice"}, {"levels", 1}}}}
                                   .dump());
    const auto fresh = json::parse(out({"solve", "truth.json", "--format", "json"}));
    EXPECT_LE(fresh["scalars"]["y"].get<double>(), 0.4);

    folder.write("known.json", R"({"powder": "known", "material": {"density": 2500}})");
    const auto refused = ask({"plan", "layer.json"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("$.factors[1].sample.powder: got \"known.json\"; this powder has no "
                                       "\"posterior\""));
}

TEST_F(Powders, HaveASchema) {
    const auto schema = json::parse(out({"schema", "powder"}));
    const auto& properties = schema["properties"];
    EXPECT_EQ(schema["required"], json{"powder"});
    for (const auto& [key, value] : ti64().items()) EXPECT_TRUE(properties.contains(key)) << key;
    for (const char* object : {"material", "contacts"}) {
        EXPECT_EQ(properties[object]["additionalProperties"], false);
        for (const auto& [key, value] : ti64()[object].items())
            EXPECT_TRUE(properties[object]["properties"].contains(key)) << key;
    }
    EXPECT_THAT(properties["contacts"]["properties"]["cohesion_law"]["enum"].dump(), HasSubstr("\"dmt\""));
    EXPECT_EQ(properties["sizes"]["oneOf"].size(), 5U);
    const auto refused = ask({"schema", "powdr"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("Did you mean 'powder'?"));
}

// Where is the layer good with 95 % for the powder as known, what does twice the surface energy do; figure, table; and
// all of it again from the database alone.
TEST_F(Powders, AnswerTheQuestionOfAnEngineer) {
    import_sizes();
    auto asked = spreading();
    asked["factors"].push_back(
        {{"name", "surface_energy"}, {"lognormal", {{"median", "0.05 mJ/m2"}, {"ratio", 1.5}}}, {"role", "noise"}});
    asked["fixed"].update({{"gap", "120 um"},
                           {"tool_scale", "0.4 mm"},
                           {"travel", "32*diameter"},
                           {"layer_beyond", "12*diameter"},
                           {"layer_area", "0.55*1.5*gap*(travel + layer_beyond)"}});
    asked["accuracy"] = "survey";
    asked["fixed"]["settle_time"] = "5 ms";
    asked["design"]["points"] = 12;
    folder.write("ti64.json", [] {
        auto soft = ti64();
        soft["material"]["youngs_modulus"] = "1 MPa";
        return soft.dump();
    }());
    auto unknown = asked;
    unknown["fixed"]["layer_height"] = "60 um";
    folder.write("ti.json", unknown.dump());
    EXPECT_THAT(ask({"plan", "ti.json"}).err, HasSubstr("Did you mean 'gap'?"));
    folder.write("ti.json", asked.dump(1));
    out({"run", "ti.json", "-j", "2", "--quiet"});

    const Folder empty(in_memory());
    fs::rename(folder.path() / "ti.db", empty.path() / "ti.db");
    const auto say = [&](const std::vector<std::string>& arguments) {
        const auto ended = run_program(arguments, empty.path());
        EXPECT_EQ(ended.code, 0) << arguments[0] << ": " << ended.err;
        return ended.out;
    };
    const std::vector<std::string> question = {"window",     "ti.db", "--where",  "tool_force <= 0.01",
                                               "--maximize", "speed", "--format", "json"};
    auto doubled = question;
    doubled.insert(doubled.end(), {"--hold", "surface_energy=0.1 mJ/m2"});
    const auto known = json::parse(say(question)), sticky = json::parse(say(doubled));
    EXPECT_TRUE(known["best"]["inputs"]["surface_energy"].is_null());
    EXPECT_EQ(sticky["best"]["inputs"]["surface_energy"], 1e-4);
    say({"figure", "ti.db", "effects", "-o", "effects.pdf", "--width", "85mm"});
    EXPECT_TRUE(text_of(empty.path() / "effects.pdf").starts_with("%PDF"));
    say({"query", "ti.db", "SELECT * FROM ti", "--format", "xlsx", "-o", "ti.xlsx"});
    EXPECT_TRUE(text_of(empty.path() / "ti.xlsx").starts_with("PK"));
    const auto ids = json::parse(say({"query", "ti.db", "SELECT case_id FROM ti LIMIT 2", "--format", "json"}));
    for (const auto& row : ids)
        EXPECT_TRUE(json::parse(say({"replay", "ti.db", row["case_id"], "--format", "json"}))["agrees"]);
}

}  // namespace grainsweep::tests::powders_test
