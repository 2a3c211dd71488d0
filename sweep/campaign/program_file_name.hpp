// The name of a file of a program, from a campaign file or from a database that anybody may have made.
#pragma once

#include <string_view>

namespace grainsweep::campaign {

/// Why a file of that name would not lie in the folder of its case; empty: it does.
[[nodiscard]] std::string_view flaw_of_file_name(std::string_view name);

}  // namespace grainsweep::campaign
