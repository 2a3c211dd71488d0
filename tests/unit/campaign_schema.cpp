// The schema and the reader know the same keys: whatever one refuses, so does the other.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/schema.hpp"
#include "tests/support/places.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace grainsweep::tests::campaign_schema_test {

using namespace campaign;
using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.insert(key);
    return keys;
}

std::set<std::string> key_names(std::span<const Field> keys) {
    std::set<std::string> names = {std::string(notes_key)};
    for (const auto& key : keys) names.emplace(key.name);
    return names;
}

const json& schema() {
    static const json parsed = json::parse(campaign_schema());
    return parsed;
}

bool reads(const json& document) {
    try {
        (void)parse_campaign(document.dump(), ".");
        return true;
    } catch (const InputError&) {
        return false;
    }
}

const json sound = json::parse(R"({"campaign": "trial", "scene": "rehearsal",
    "factors": [{"name": "x1", "between": [0, 1]}], "fixed": {"noise": 0.1},
    "design": {"kind": "halton", "points": 64, "sequences": 4},
    "convergence": {"observable": "y"}, "limits": {"attempts": 1}, "execution": {"workers": 1}})");

TEST(Schema, IsDraft2020AndRefusesUnknownKeysEverywhere) {
    EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
    EXPECT_EQ(schema()["additionalProperties"], false);
    for (const char* section : {"convergence", "limits", "execution"}) {
        EXPECT_EQ(schema()["properties"][section]["additionalProperties"], false) << section;
    }
    for (const auto& design : schema()["properties"]["design"]["oneOf"]) {
        EXPECT_EQ(design["additionalProperties"], false);
    }
}

TEST(Schema, HasTheKeysOfTheReader) {
    const auto& properties = schema()["properties"];
    auto of_the_file = key_names(campaign_keys);
    of_the_file.emplace(schema_key);
    EXPECT_EQ(keys_of(properties), of_the_file);
    EXPECT_EQ(keys_of(properties["convergence"]["properties"]), key_names(convergence_keys));
    EXPECT_EQ(keys_of(properties["limits"]["properties"]), key_names(limits_keys));
    EXPECT_EQ(keys_of(properties["execution"]["properties"]), key_names(execution_keys));
    const auto designs = designs::design_catalogue();
    ASSERT_EQ(properties["design"]["oneOf"].size(), designs.size());
    for (std::size_t k = 0; k < designs.size(); ++k) {
        EXPECT_EQ(keys_of(properties["design"]["oneOf"][k]["properties"]), key_names(design_keys(designs[k])));
    }
}

TEST(Schema, RefusesTheNamesTheReaderRefuses) {
    const std::regex forbidden(schema()["properties"]["campaign"]["not"]["pattern"].get<std::string>());
    const std::regex allowed(schema()["properties"]["campaign"]["pattern"].get<std::string>());
    std::vector<std::string> names = {"trial",   "seriess", "my_series", "SQLite_x",
                                      "sqlitex", "2nd",     "a-b",       "Case_Input"};
    for (const auto& name : reserved_names) {
        names.emplace_back(name);
        names.push_back(static_cast<char>(name.front() - 'a' + 'A') + std::string(name.substr(1)));
    }
    for (const auto& name : names) {
        json named = sound;
        named["campaign"] = name;
        EXPECT_EQ(reads(named), std::regex_search(name, allowed) && !std::regex_search(name, forbidden)) << name;
    }
}

TEST(Schema, HasEveryParameterOfEveryScene) {
    const auto scenes = campaign::named_scenes();
    ASSERT_EQ(schema()["allOf"].size(), scenes.size() + 2);  // and those of a program and of a machine
    EXPECT_EQ(schema()["allOf"][scenes.size()]["if"]["properties"]["scene"]["const"], "program");
    EXPECT_EQ(schema()["allOf"].back()["if"]["properties"]["scene"]["const"], "machine");
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        const auto& rule = schema()["allOf"][k];
        EXPECT_EQ(rule["if"]["properties"]["scene"]["const"], scenes[k]->shown());
        const auto& fixed = rule["then"]["properties"]["fixed"]["properties"];
        const auto& factors = rule["then"]["properties"]["factors"]["items"]["oneOf"];
        ASSERT_EQ(factors.size(), scenes[k]->parameters.size());
        for (std::size_t j = 0; j < factors.size(); ++j) {
            const auto& parameter = scenes[k]->parameters[j];
            EXPECT_EQ(factors[j]["properties"]["name"]["const"], parameter.name);
            ASSERT_TRUE(fixed.contains(parameter.name));
            const auto* bounds = std::get_if<Interval>(&parameter.bounds);
            if (bounds != nullptr && std::isfinite(bounds->high)) {
                EXPECT_EQ(fixed[parameter.name][bounds->high_open ? "exclusiveMaximum" : "maximum"], bounds->high);
            }
            const bool number = !std::holds_alternative<std::string>(parameter.default_value);
            EXPECT_EQ(factors[j]["properties"].contains("between"), number) << parameter.name;
            const bool real = std::holds_alternative<double>(parameter.default_value);
            EXPECT_EQ(factors[j]["properties"].contains("normal"), real) << parameter.name;
        }
    }
}

TEST(Schema, EveryKeyItHasIsReadAndEveryOtherRefused) {
    ASSERT_TRUE(reads(sound));
    for (const char* section : {"", "/convergence", "/limits", "/execution", "/design", "/factors/0", "/fixed"}) {
        const json::json_pointer place{std::string(section)};
        json noted = sound;
        noted[place]["notes"] = {"a remark", "and another"};
        EXPECT_TRUE(reads(noted)) << section;
        json unknown = sound;
        unknown[place]["note"] = "a remark";
        EXPECT_FALSE(reads(unknown)) << section;
    }
    for (const auto& key : campaign_keys) {
        json without = sound;
        without.erase(std::string(key.name));
        const bool needed = key.required || key.name == "design" || key.name == "scene";  // or a calibration
        EXPECT_EQ(reads(without), !needed) << key.name;
    }
    EXPECT_FALSE(schema()["oneOf"].is_null()) << "either a design or a calibration";
}

TEST(Schema, DefaultsAreThoseOfTheReader) {
    json bare = sound;
    bare.erase("limits");
    bare.erase("execution");
    const auto campaign = parse_campaign(bare.dump(), ".");
    const auto& properties = schema()["properties"];
    EXPECT_EQ(properties["seed"]["default"], campaign.seed);
    EXPECT_EQ(properties["replicates"]["default"], campaign.replicates);
    EXPECT_EQ(properties["limits"]["properties"]["attempts"]["default"], campaign.limits.attempts);
    EXPECT_EQ(properties["limits"]["properties"]["wall_seconds"]["default"], campaign.limits.wall_seconds.value_or(0));
    EXPECT_EQ(properties["execution"]["properties"]["workers"]["default"], campaign.execution.workers.value_or(0));
    const auto& convergence = properties["convergence"]["properties"];
    EXPECT_EQ(convergence["rule"]["default"], campaign.convergence->rule);
    EXPECT_EQ(convergence["gates"]["default"], campaign.convergence->gates);
    EXPECT_EQ(convergence["tolerance"]["default"], campaign.convergence->tolerance);
    EXPECT_FALSE(convergence["block"].contains("default")) << "it follows from the design";
    EXPECT_EQ(convergence["stop"]["default"], campaign.convergence->stop);
}

/// Returns the path of the first part that breaks the schema; empty: none. Knows the words that our schemas use.
std::string broken_at(const json& rule, const json& value, const json& root, const std::string& path = "$") {
    if (rule.is_boolean()) return rule.get<bool>() ? "" : path;
    if (rule.contains("$ref"))
        return broken_at(root.at(json::json_pointer(rule["$ref"].get<std::string>().substr(1))), value, root, path);
    if (rule.contains("type")) {
        const auto fits = [&](const std::string& type) {
            return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
                   (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
                   (type == "number" && value.is_number()) || (type == "integer" && value.is_number_integer());
        };
        const auto types = rule["type"].is_array() ? rule["type"].get<std::vector<std::string>>()
                                                   : std::vector{rule["type"].get<std::string>()};
        if (std::ranges::none_of(types, fits)) return path;
    }
    if (value.is_string() && rule.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(rule["pattern"].get<std::string>())))
        return path;
    if (rule.contains("enum") && std::ranges::find(rule["enum"], value) == rule["enum"].end()) return path;
    if (value.is_number()) {
        const double x = value.get<double>();
        if (x < rule.value("minimum", x) || x > rule.value("maximum", x)) return path;
        if (rule.contains("exclusiveMinimum") && x <= rule["exclusiveMinimum"].get<double>()) return path;
    }
    const auto breaks = [&](const json& part) { return !broken_at(part, value, root, path).empty(); };
    if (rule.contains("anyOf") && std::ranges::all_of(rule["anyOf"], breaks)) return path;
    if (rule.contains("oneOf") && std::ranges::count_if(rule["oneOf"], breaks) + 1 != std::ssize(rule["oneOf"]))
        return path;
    if (value.is_array()) {
        if (value.size() < rule.value("minItems", 0U) || value.size() > rule.value("maxItems", value.size()))
            return path;
        for (std::size_t k = 0; rule.contains("items") && k < value.size(); ++k)
            if (auto at = broken_at(rule["items"], value[k], root, fmt::format("{}[{}]", path, k)); !at.empty())
                return at;
    }
    if (!value.is_object()) return "";
    for (const auto& key : rule.value("required", json::array()))
        if (!value.contains(key.get<std::string>())) return path + "." + key.get<std::string>();
    for (const auto& [key, inner] : value.items()) {
        const json& properties = rule.contains("properties") ? rule["properties"] : json::object();
        const json part = properties.contains(key) ? properties[key] : rule.value("additionalProperties", json(true));
        if (auto at = broken_at(part, inner, root, path + "." + key); !at.empty()) return at;
    }
    return "";
}

TEST(MachineSchema, AcceptsEveryInstalledMachine) {
    const json rule = json::parse(machine_schema());
    std::size_t checked = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(tests::source("configs"))) {
        if (entry.path().extension() != ".json") continue;
        std::ifstream file(entry.path());
        const json document = json::parse(file);
        if (!is_machine_document(document)) continue;
        EXPECT_EQ(broken_at(rule, document, rule), "") << entry.path();
        ++checked;
    }
    EXPECT_GE(checked, 20U);
}

TEST(MachineSchema, RefusesAtTheSamePlaceAsTheReader) {
    const json rule = json::parse(machine_schema());
    const json drop =
        json::parse(R"({"name": "drop", "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
        "species": {"bead": {"diameter": "2 mm"}},
        "walls": {"drum": {"cylinder": {"radius": "50 mm", "length": "40 mm"}, "motion": [{"rotate": {"axis": [0, 1, 0], "speed": 1}}]}},
        "fill": [{"species": "bead", "count": 10, "in": {"any": [{"ball": {"centre": [0, 0, 0], "radius": "2 cm"}}]}}],
        "domain": {"low": [-1, -1, -1], "high": [1, 1, 1]},
        "phases": [{"name": "turn", "for": 1}], "measure": {"speed": {"rms_speed": {}}}})");
    const auto reads_machine = [](const json& document) {
        try {
            (void)make_machine(document, "$", [](const std::string&) { return std::string(); });
            return true;
        } catch (const InputError&) {
            return false;
        }
    };
    ASSERT_TRUE(reads_machine(drop));
    ASSERT_EQ(broken_at(rule, drop, rule), "");
    json noted = drop;
    noted["$schema"] = "machine.schema.json";
    noted["walls"]["drum"]["notes"] = "of steel";
    EXPECT_TRUE(reads_machine(noted));
    EXPECT_EQ(broken_at(rule, noted, rule), "");
    const std::pair<const char*, json> changes[] = {{"/walls/drum/cylinder/radios", 1},
                                                    {"/walls/drum/motion/0/rotate/axis", {1, 0}},
                                                    {"/walls/drum/motion/0/turn", json::object()},
                                                    {"/walls/drum/motion/0/shift", {{"velocity", {0, 0, 0}}}},
                                                    {"/walls/drum/plane", {{"normal", {0, 0, 1}}}},
                                                    {"/walls/drum/cylinder/side", "within"},
                                                    {"/fill/0/in", {{"bowl", json::object()}}},
                                                    {"/fill/0/as", "rein"},
                                                    {"/measure/speed/rms_sped", json::object()},
                                                    {"/materials/glass/poisson_ratio", 0.7},
                                                    {"/phases/0/frame", 10}};
    for (const auto& [place, value] : changes) {
        json wrong = drop;
        wrong[json::json_pointer(place)] = value;
        EXPECT_FALSE(reads_machine(wrong)) << place;
        EXPECT_NE(broken_at(rule, wrong, rule), "") << place;
    }
}

TEST(Configs, EveryFileReadsWithoutError) {
    std::size_t read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(tests::source("configs"))) {
        if (entry.path().extension() != ".json") continue;
        EXPECT_NO_THROW({
            const auto experiments = read_experiment_names(entry.path());
            if (experiments.empty()) {
                EXPECT_EQ(read_campaign(entry.path()).name, entry.path().stem().string());
            }
            for (const auto& name : experiments)
                EXPECT_EQ(read_campaign(entry.path(), name).name, entry.path().stem().string() + "_" + name);
        }) << entry.path();
        ++read;
    }
    EXPECT_GT(read, 0U);
}

}  // namespace grainsweep::tests::campaign_schema_test
