// Manual page, generated from the table of commands, the scenes, the designs and the keys of a campaign file.
#pragma once

#include "sweep/cli/command.hpp"

#include <span>
#include <string>

namespace grainsweep::cli {

/// Returns grainsweep.1 in the man macros of troff.
[[nodiscard]] std::string manual_page(std::span<const CommandInfo> commands);

}  // namespace grainsweep::cli
