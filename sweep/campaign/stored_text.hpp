// Texts that an archive keeps as they are and does not interpret: the campaign file, and an attempt's seconds by phase.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// What a campaign file says beside what is in the identity of its campaign.
struct Remarks {
    std::string notes;                     ///< at its top level, one line for each text of a list
    std::optional<std::int64_t> attempts;  ///< limits.attempts, where it says so
};
/// Of a campaign file that was read and stored by this program or an older one; empty where it is none.
[[nodiscard]] Remarks remarks_in(std::string_view campaign_file);

using PhaseSeconds = decltype(Cost::phases);
/// As a JSON object; phases whose time is no number are left out. None where there are no phases.
[[nodiscard]] std::optional<std::string> phases_text(const PhaseSeconds& phases);
/// What phases_text wrote; none where it is something else.
[[nodiscard]] std::optional<PhaseSeconds> phases_in(std::string_view text);

}  // namespace grainsweep::campaign
