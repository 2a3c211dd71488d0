// Names of letters, digits and _, as expressions and SQL have them, and texts without upper case, as SQL compares
// names.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

[[nodiscard]] constexpr bool is_name_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
[[nodiscard]] constexpr bool is_name_sign(char c) {
    return is_name_letter(c) || (c >= '0' && c <= '9');
}
/// Returns whether a word has only letters, digits and _, no digit first.
[[nodiscard]] constexpr bool is_plain_name(std::string_view word) {
    return !word.empty() && is_name_letter(word.front()) && std::ranges::all_of(word, is_name_sign);
}

[[nodiscard]] constexpr char small_letter(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
[[nodiscard]] inline std::string small_letters(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), small_letter);
    return small;
}

}  // namespace grainsweep::campaign
