// "powder" of a species. Internal to the reader of machines.
#pragma once

#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/machine.hpp"

#include <map>
#include <string>

namespace grainsweep::campaign {

/// Returns the machine with the powders of its species written out; what the machine states beside a powder stays. Adds
/// the sizes to `made`, under the names that the returned document has for them. Throws WrongQuestion.
[[nodiscard]] Json with_powders(Json document, const std::string& root, const FileReader& read,
                                std::map<std::string, std::string, std::less<>>& made);

}  // namespace grainsweep::campaign
