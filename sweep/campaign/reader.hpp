// Reader of campaign files: from JSON to a checked Campaign, or one sentence with the error.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Reads and checks a campaign file. Throws InputError with the file, the JSON path, the value, the rule and the
/// nearest valid word. Files that it names (a packing, listed rows) lie beside it. For a calibration with several
/// experiments `experiment` chooses the campaign; it is empty for every other file.
[[nodiscard]] Campaign read_campaign(const std::filesystem::path& file, std::string_view experiment = {});

/// Reads the same from text; `folder`: folder of the files that it names.
[[nodiscard]] Campaign parse_campaign(std::string_view text, const std::filesystem::path& folder,
                                      std::string_view experiment = {});

/// Returns the experiments of a campaign file, ordered by name; empty if it has only one. Throws like read_campaign.
[[nodiscard]] std::vector<std::string> read_experiment_names(const std::filesystem::path& file);

/// Returns whether the campaign file has an error goal: "accuracy" as an object. Throws like read_campaign.
[[nodiscard]] bool states_goal(const std::filesystem::path& file);

/// Returns a value of a parameter from a command line ("0.3", "60 um", "sjkr"), checked like a value of a campaign
/// file. `where`: its place in messages.
[[nodiscard]] Value parse_value(const ParameterSpec& parameter, std::string_view word,
                                const std::filesystem::path& folder, std::string_view where);

}  // namespace grainsweep::campaign
