// The schema and the reader know the same keys: whatever one refuses, so does the other.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/schema.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

namespace grainsweep::tests::campaign_schema_test {

using namespace campaign;
using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.insert(key);
    return keys;
}

std::set<std::string> key_names(std::span<const Key> keys) {
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
    } catch (const WrongQuestion&) {
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
    EXPECT_EQ(keys_of(properties), key_names(campaign_keys()));
    EXPECT_EQ(keys_of(properties["convergence"]["properties"]), key_names(convergence_keys()));
    EXPECT_EQ(keys_of(properties["limits"]["properties"]), key_names(limits_keys()));
    EXPECT_EQ(keys_of(properties["execution"]["properties"]), key_names(execution_keys()));
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
    for (const auto& name : reserved_names()) {
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
    for (const auto& key : campaign_keys()) {
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
