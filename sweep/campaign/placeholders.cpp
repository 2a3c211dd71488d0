#include "sweep/campaign/placeholders.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_word_sign(char c) {
    return is_letter(c) || (c >= '0' && c <= '9');
}

/// The name that begins the text and ends before `end`; empty: none.
std::string_view name_before(std::string_view text, std::string_view end) {
    const auto last = std::ranges::find_if_not(text, is_word_sign);
    const auto name = text.substr(0, static_cast<std::size_t>(last - text.begin()));
    return is_plain_name(name) && text.substr(name.size()).starts_with(end) ? name : std::string_view();
}

}  // namespace

bool is_plain_name(std::string_view word) {
    return !word.empty() && is_letter(word.front()) && std::ranges::all_of(word, is_word_sign);
}

std::string filled_command(std::string_view text, const ValueOf& value_of) {
    std::string filled;
    while (!text.empty()) {
        if (text.starts_with("{{")) {
            if (const auto name = name_before(text.substr(2), "}}"); !name.empty()) {
                filled.append("{").append(name).append("}");
                text.remove_prefix(name.size() + 4);
                continue;
            }
        } else if (text.front() == '{') {
            if (const auto name = name_before(text.substr(1), "}"); !name.empty()) {
                filled += value_of(name);
                text.remove_prefix(name.size() + 2);
                continue;
            }
        }
        filled += text.front();
        text.remove_prefix(1);
    }
    return filled;
}

std::string filled_template(std::string_view text, const ValueOf& value_of) {
    std::string filled;
    std::size_t line = 1;
    while (true) {
        const auto open = text.find("{{");
        const auto plain = text.substr(0, open);
        filled += plain;
        line += static_cast<std::size_t>(std::ranges::count(plain, '\n'));
        if (open == std::string_view::npos) return filled;
        text.remove_prefix(open);
        const auto close = text.find("}}");
        if (close == std::string_view::npos || text.substr(0, close).find('\n') != std::string_view::npos) {
            filled += "{{";
            text.remove_prefix(2);
            continue;
        }
        const auto name = trimmed(text.substr(2, close - 2));
        if (!is_plain_name(name))
            throw std::invalid_argument(fmt::format(
                "line {}: '{}' holds no name; a placeholder is {{{{ name }}}}, and what is to stay as it is "
                "belongs to \"files\"",
                line, text.substr(0, std::min<std::size_t>(close + 2, 60))));
        filled += value_of(name);
        text.remove_prefix(close + 2);
    }
}

}  // namespace grainsweep::campaign
