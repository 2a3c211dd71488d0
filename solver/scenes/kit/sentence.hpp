// Sentences with numbers in them, for warnings and for what is refused.
#pragma once

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace grainsweep::kit {

/// The format, as of printf, with the numbers it asks for; of 400 characters at most.
[[nodiscard]] inline std::string sentence(const char* format, double a, double b = 0, double c = 0, double d = 0) {
    std::array<char, 401> buffer{};
    std::snprintf(buffer.data(), buffer.size(), format, a, b, c, d);
    return buffer.data();
}

/// a >= b up to rounding: 0.0045 is three times 0.0015, though 3 * 0.0015 is greater.
[[nodiscard]] inline bool at_least(double a, double b) {
    return a >= b * (1 - 1e-12);
}

/// Throws std::invalid_argument with the sentence where something does not hold.
inline void require(bool holds, const std::string& words) {
    if (!holds) throw std::invalid_argument(words);
}

}  // namespace grainsweep::kit
