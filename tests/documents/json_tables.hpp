// Generated tables of docs/json.md: the keys that commands print with --format json.
#pragma once

#include <string>

namespace grainsweep::tests {

/// Returns the fields of a result. Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::string json_table(const std::string& name);

}  // namespace grainsweep::tests
