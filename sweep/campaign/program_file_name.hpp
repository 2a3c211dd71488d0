// Check of the name of a program's file, from a campaign file or from an untrusted database.
#pragma once

#include <string_view>

namespace grainsweep::campaign {

/// Returns why a file of this name would not lie in the folder of its case; empty: it would.
[[nodiscard]] std::string_view flaw_of_file_name(std::string_view name);

}  // namespace grainsweep::campaign
