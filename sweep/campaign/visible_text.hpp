// External text made safe for display: control characters of terminals (C0, DEL and C1) are shown as \x1b.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Returns the safe text; line breaks and tabs do not change.
[[nodiscard]] std::string visible(std::string_view text);
/// Replaces every byte that is no part of a character in UTF-8 (RFC 3629) by U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

}  // namespace grainsweep::campaign
