// Text from outside, fit to be shown: what a terminal would obey (C0, DEL and C1 control characters) stands as \x1b.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Line breaks and tabs stay as they are.
[[nodiscard]] std::string visible(std::string_view text);

}  // namespace grainsweep::campaign
