// The campaign file: from JSON to a checked Campaign, or one sentence saying what is wrong with it.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Reads and checks a campaign file. Throws WrongQuestion naming the file, the JSON path, the value, the rule
/// and the nearest right word. Files it names (a packing, listed rows) lie beside it. A calibration over several
/// experiments has a campaign of each, and `experiment` chooses one; it is empty for every other file.
[[nodiscard]] Campaign read_campaign(const std::filesystem::path& file, std::string_view experiment = {});

/// The same from text; `folder` is where the files it names lie.
[[nodiscard]] Campaign parse_campaign(std::string_view text, const std::filesystem::path& folder,
                                      std::string_view experiment = {});

/// The experiments of a campaign file, ordered by name; empty where it is of one. Throws as read_campaign does.
[[nodiscard]] std::vector<std::string> read_experiment_names(const std::filesystem::path& file);

/// Whether the campaign file says what its answer may be off by: "accuracy" as an object. Throws as read_campaign does.
[[nodiscard]] bool states_goal(const std::filesystem::path& file);

/// A value of a parameter as a command line gives it ("0.3", "60 um", "sjkr"), checked as a campaign file's would be.
/// `where` names the place in messages.
[[nodiscard]] Value parse_value(const ParameterSpec& parameter, std::string_view word,
                                const std::filesystem::path& folder, std::string_view where);

}  // namespace grainsweep::campaign
