// Warnings of a campaign of a program: numbers that lose their value in a format, parameters and seeds that reach the
// program nowhere, and files whose contents are no part of a case.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/program.hpp"

#include <string>
#include <vector>

namespace grainsweep::campaign {

/// Placeholder in a program, and where it stands: "command[2]".
struct PlacedName {
    std::string name, format, place;
};
/// Returns the placeholders of command, environment and templates, as far as the contents of these are in memory.
[[nodiscard]] std::vector<PlacedName> placed_names(const Program& program);

/// Returns a warning for each number that its format changes by more than 1 %.
[[nodiscard]] std::vector<Warning> format_warnings(const std::vector<PlacedName>& placed, const Inputs& inputs);

/// Returns a warning for each parameter that varies and stands in no placeholder, where others do; for replicates
/// without a seed; and for each file of the command that may change unnoticed.
[[nodiscard]] std::vector<std::string> program_warnings(const Campaign& campaign);

}  // namespace grainsweep::campaign
