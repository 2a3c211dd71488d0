// Words and numbers in text from a user or another program, independent of the locale.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep {

/// Returns the text without blanks, tabulators and carriage returns at either end.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Returns whether a decimal number outside the range of double is too small (not too large).
[[nodiscard]] inline bool is_too_small(std::string_view number) {
    const auto mark = std::min(number.find_first_of("eE"), number.size());
    const auto digits = number.substr(0, mark);
    const auto exponent = number.substr(std::min(mark + 1, number.size()));
    long power = 0;  // of ten
    const auto* const begin = exponent.data() + (exponent.starts_with('+') ? 1 : 0);
    if (std::from_chars(begin, exponent.data() + exponent.size(), power).ec == std::errc::result_out_of_range)
        return exponent.starts_with('-');
    const auto point = static_cast<long>(std::min(digits.find('.'), digits.size()));
    return static_cast<long>(digits.find_first_of("123456789")) - point > power;
}

/// Returns the number if the whole word is one, also infinite or NaN. Empty: it is no number, or too large for double.
/// A number too small for double is 0.
[[nodiscard]] inline std::optional<double> any_number_in(std::string_view word) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (end != word.data() + word.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range && is_too_small(word)) return word.starts_with('-') ? -0.0 : 0.0;
    if (error != std::errc()) return std::nullopt;
    return number;
}

/// Returns the number if the whole word is a finite number.
[[nodiscard]] inline std::optional<double> number_in(std::string_view word) {
    const auto number = any_number_in(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Returns the words as numbers; empty if one is no number.
[[nodiscard]] inline std::vector<double> numbers_in(std::span<const std::string> words) {
    std::vector<double> numbers;
    for (const std::string& word : words) {
        const auto number = any_number_in(word);
        if (!number) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

/// Returns the shortest text that reads back as the same number.
[[nodiscard]] inline std::string shortest_text(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

}  // namespace grainsweep
