// Files that a campaign uses, for the database. Internal to the reader.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/powder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::campaign {

/// Returns every file in `folder` that a text of the campaign file names: lists, curves, tools, packings, sizes. Files
/// of programs and machines are stored separately; notes do not name files.
[[nodiscard]] std::vector<CampaignFile> files_beside(const Json& document, const std::filesystem::path& folder);
/// Adds the powder file, the files that it names, and its sizes.
void add_powder_files(const std::string& place, const Powder& powder, Campaign& campaign);

}  // namespace grainsweep::campaign
