// Sentences with numbers, for warnings and refusals.
#pragma once

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace grainsweep::kit {

/// Returns the text of a printf format with numbers, at most 400 characters.
[[nodiscard]] inline std::string sentence(const char* format, double a, double b = 0, double c = 0, double d = 0) {
    std::array<char, 401> buffer{};
    std::snprintf(buffer.data(), buffer.size(), format, a, b, c, d);
    return buffer.data();
}

/// Throws std::invalid_argument with the sentence if `holds` is false.
inline void require(bool holds, const std::string& words) {
    if (!holds) throw std::invalid_argument(words);
}

}  // namespace grainsweep::kit
