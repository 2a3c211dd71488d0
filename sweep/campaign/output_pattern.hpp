// Regular expressions of campaign files and databases, for the output of programs.
#pragma once

#include <regex>
#include <string>

namespace grainsweep::campaign {

/// Returns an ECMAScript pattern without back-references. All ways to match are followed in parallel, because
/// backtracking would need 2^n steps for (a+)+$ and a line of n letters. Throws std::regex_error.
[[nodiscard]] inline std::regex output_pattern(const std::string& pattern) {
    return std::regex(pattern, std::regex::ECMAScript | std::regex_constants::__polynomial);
}

}  // namespace grainsweep::campaign
