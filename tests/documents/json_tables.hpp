// Generated tables of docs/json.md: the keys that commands print with --format json.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::tests {

/// Returns the keys and types of a command's output on a small campaign. Throws std::invalid_argument for a command
/// that it does not run.
[[nodiscard]] std::string json_table(const std::string& command);

}  // namespace grainsweep::tests
