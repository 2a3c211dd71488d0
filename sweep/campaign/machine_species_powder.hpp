// "powder" of a species. Internal to the reader of machines.
#pragma once

#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/machine.hpp"

#include <map>
#include <string>

namespace grainsweep::campaign {

/// Returns the machine with the powders of its species expanded; values that the machine gives itself have priority.
/// Adds the sizes to `made`, under their names in the returned document. Throws InputError.
[[nodiscard]] Json with_powders(Json document, const std::string& root, const FileReader& read,
                                std::map<std::string, std::string, std::less<>>& made);

}  // namespace grainsweep::campaign
