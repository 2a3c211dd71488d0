// Figures in the data of a page, as its script unpacks them.
#pragma once

#include <nlohmann/json.hpp>

namespace grainsweep::tests {

/// Returns the figures of an object with the member "figures".
[[nodiscard]] nlohmann::ordered_json drawings_of(const nlohmann::ordered_json& campaign);

}  // namespace grainsweep::tests
