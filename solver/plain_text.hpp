// Words and numbers of text that a user or another program wrote: blanks around a word, a number that is all of a
// word, the shortest text that reads back as the same number. Independent of the locale.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep {

/// Without blanks, tabulators and carriage returns at either end.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The number that the whole word is, infinite or NaN, too; none: it is something else, or beyond the range of double.
[[nodiscard]] inline std::optional<double> any_number_in(std::string_view word) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
}

/// The finite number that the whole word is.
[[nodiscard]] inline std::optional<double> number_in(std::string_view word) {
    const auto number = any_number_in(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

/// The shortest text that reads back as the same number.
[[nodiscard]] inline std::string shortest_text(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

}  // namespace grainsweep
