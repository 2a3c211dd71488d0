// Campaigns that shell scripts answer, for tests of the real executable.
#pragma once

#include "tests/support/process.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace grainsweep::tests {

/// A campaign "p" over x in [0, 1] with so many points: "script.sh" answers, its observable y in out.json. `more` are
/// further keys of the section "program", over those here.
[[nodiscard]] inline nlohmann::json script_campaign(int points, const nlohmann::json& more = {}) {
    nlohmann::json campaign = {
        {"campaign", "p"},
        {"scene", "program"},
        {"program",
         {{"command", {"sh", "script.sh", "{x}"}},
          {"files", {"script.sh"}},
          {"cost_seconds", 0.01},
          {"observables", {{"y", {{"unit", "1"}, {"from", {{"json", "out.json"}, {"path", "/y"}}}}}}}}},
        {"factors", {{{"name", "x"}, {"between", {0, 1}}}}},
        {"design", {{"kind", "halton"}, {"scramble", "none"}, {"points", points}}},
        {"limits", {{"attempts", 2}}}};
    if (more.is_object()) campaign["program"].merge_patch(more);
    return campaign;
}

/// Writes script and campaign and runs it.
[[nodiscard]] inline Ended run_script(const Folder& folder, const std::string& script, const nlohmann::json& campaign,
                                      std::vector<std::string> options = {"-j", "2"}) {
    folder.write("script.sh", script);
    folder.write("c.json", campaign.dump());
    options.insert(options.begin(), {"run", "c.json"});
    return run_program(options, folder.path());
}

/// Rows of a query of the campaign's database.
[[nodiscard]] inline nlohmann::json rows_of(const Folder& folder, const std::string& sql) {
    const auto ended = run_program({"query", "p.db", sql, "--format", "json"}, folder.path());
    return ended.code == 0 ? nlohmann::json::parse(ended.out) : nlohmann::json(ended.err);
}

}  // namespace grainsweep::tests
