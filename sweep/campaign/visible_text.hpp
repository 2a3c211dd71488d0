// Text from outside, fit to be shown: what a terminal would obey (C0, DEL and C1 control characters) stands as \x1b.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Line breaks and tabs stay as they are.
[[nodiscard]] std::string visible(std::string_view text);
/// Replaces every byte that is no part of a character in UTF-8 (RFC 3629) by U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

}  // namespace grainsweep::campaign
