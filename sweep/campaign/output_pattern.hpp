// Regular expressions of campaign files and databases, searched for in what programs write.
#pragma once

#include <regex>
#include <string>

namespace grainsweep::campaign {

/// ECMAScript without back-references. All ways to match are followed side by side: one after another, (a+)+$ needs 2^n
/// steps for a line of n letters. Throws std::regex_error.
[[nodiscard]] inline std::regex output_pattern(const std::string& pattern) {
    return std::regex(pattern, std::regex::ECMAScript | std::regex_constants::__polynomial);
}

}  // namespace grainsweep::campaign
