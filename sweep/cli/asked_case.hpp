// Case that the user names by a file and some settings: of a campaign, or of a machine.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::cli {

struct AskedCase {
    campaign::Case question;
    std::optional<double> limit_seconds;
    std::vector<std::string> shown_inputs;  ///< names of the factors and of what --set gives
    std::string campaign;                   ///< name; empty: of a machine alone
};

/// Reads a campaign file, or the file or the name of a machine; `settings` are NAME=VALUE. Other factors take the
/// middle of their range, or their first level. `seed`: empty: the campaign's for this case. Prints a point that the
/// campaign excludes, and what its powder lacks. Throws InputError.
[[nodiscard]] AskedCase asked_case(const std::string& config, const std::vector<std::string>& settings,
                                   std::optional<std::uint64_t> seed);

}  // namespace grainsweep::cli
