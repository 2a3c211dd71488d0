#include "sweep/campaign/visible_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace grainsweep::campaign {
namespace {

/// Bytes of the character at the start of the text; 0: none begins there.
std::size_t bytes_of_character(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80U    ? 1
                               : first < 0xC2U  ? 0  // inside of a character, or longer than need be
                               : first < 0xE0U  ? 2
                               : first < 0xF0U  ? 3
                               : first <= 0xF4U ? 4
                                                : 0;
    if (length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xC0U) != 0x80U) return 0;
    const unsigned second = length > 1 ? byte(1) : 0;
    const bool wrong = (first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second >= 0xA0U) ||
                       (first == 0xF0U && second < 0x90U) || (first == 0xF4U && second >= 0x90U);
    return wrong ? 0 : length;
}

}  // namespace

std::string valid_utf8(std::string_view text) {
    std::string valid;
    valid.reserve(text.size());
    while (!text.empty()) {
        const auto bytes = bytes_of_character(text);
        valid += bytes > 0 ? text.substr(0, bytes) : std::string_view("\xEF\xBF\xBD");
        text.remove_prefix(std::max<std::size_t>(1, bytes));
    }
    return valid;
}

std::string visible(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto c = static_cast<unsigned char>(text[k]);
        const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0U;
        if ((c < 0x20U && c != '\n' && c != '\t') || c == 0x7FU) {
            shown += fmt::format("\\x{:02x}", c);
        } else if (c == 0xC2U && next >= 0x80U && next < 0xA0U) {  // U+0080 to U+009F in UTF-8
            shown += fmt::format("\\x{:02x}", next);
            ++k;
        } else {
            shown += text[k];
        }
    }
    return shown;
}

}  // namespace grainsweep::campaign
