// docs/campaign_file.md and docs/factors.md show every key of the JSON Schema in an example, and no other key. Options
// of designs have tables in docs/designs_and_convergence.md.
#include "tests/documents/page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

namespace grainsweep::tests::keys_test {

using nlohmann::json;

using Keys = std::set<std::string>;  // "seed", "design.points", "factors.name"

void add_properties(Keys& keys, const std::string& section, const json& object) {
    for (const auto& [name, ignored] : object["properties"].items())
        if (name != "notes") keys.insert(section.empty() ? name : section + "." + name);
}

/// Every key a campaign file may have, whatever its scene and design.
Keys keys_of_schema() {
    const auto schema = json::parse(answer_of({"schema"}));
    Keys keys = {"notes"};
    add_properties(keys, "", schema);
    for (const char* section : {"convergence", "calibration", "model", "program", "limits", "execution"})
        add_properties(keys, section, schema["properties"][section]);
    add_properties(keys, "accuracy", schema["properties"]["accuracy"]["oneOf"][1]);
    for (const auto& design : schema["properties"]["design"]["oneOf"]) add_properties(keys, "design", design);
    for (const auto& rule : schema["allOf"]) {
        const auto& factors = rule["then"]["properties"]["factors"]["items"];
        if (!factors.contains("oneOf")) continue;  // of a program: the same keys
        for (const auto& factor : factors["oneOf"]) add_properties(keys, "factors", factor);
    }
    return keys;
}

/// Keys of a campaign file or of a part of one; `fixed` holds names of parameters.
void add_keys(Keys& keys, const json& campaign) {
    for (const auto& [name, value] : campaign.items()) {
        keys.insert(name);
        if (name == "fixed") continue;
        const auto objects = value.is_array() ? value : json::array({value});
        for (const auto& object : objects) {
            if (!object.is_object()) continue;
            for (const auto& [key, ignored] : object.items())
                if (key != "notes") keys.insert(name + "." + key);
        }
    }
}

TEST(CampaignFilePage, ShowsEveryKeyOfTheSchemaAndNoOther) {
    const auto known = keys_of_schema();
    EXPECT_GT(known.size(), 35U);
    Keys shown;
    for (const char* page : {"docs/campaign_file.md", "docs/factors.md"}) {
        for (const auto& block : read_page(page).blocks) {
            if (block.language != "json") continue;
            const auto example = json::parse(block.text, nullptr, false);
            ASSERT_FALSE(example.is_discarded()) << page << ":" << block.line << " is no JSON";
            const bool powder = example.contains("material");
            const bool machine = example.contains("materials");
            if (!powder && !machine) add_keys(shown, example);
        }
    }
    for (const auto& key : known)
        EXPECT_TRUE(shown.contains(key) || key.starts_with("design.")) << "no example of " << key;
    for (const auto& key : shown) EXPECT_TRUE(known.contains(key)) << "the schema has no key " << key;
}

}  // namespace grainsweep::tests::keys_test
