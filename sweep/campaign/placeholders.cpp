#include "sweep/campaign/placeholders.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {
namespace {

/// Name and format that begin a text before `end`; an empty name: none do.
struct Placeholder {
    std::string_view name, format;
    std::size_t length = 0;  ///< of both, with the colon
};

Placeholder placeholder_before(std::string_view text, std::string_view end) {
    const auto last = std::ranges::find_if_not(text, is_name_sign);
    const auto name = text.substr(0, static_cast<std::size_t>(last - text.begin()));
    if (!is_plain_name(name)) return {};
    const auto rest = text.substr(name.size());
    if (rest.starts_with(end)) return {name, {}, name.size()};
    const auto close = rest.find(end);
    if (!rest.starts_with(":%") || close == std::string_view::npos) return {};
    return {name, rest.substr(1, close - 1), name.size() + close};
}

constexpr std::size_t most_digits = 60;

}  // namespace

std::string filled_command(std::string_view text, const ValueOf& value_of) {
    std::string filled;
    while (!text.empty()) {
        if (text.starts_with("{{")) {
            if (const auto here = placeholder_before(text.substr(2), "}}"); !here.name.empty()) {
                filled.append("{").append(text.substr(2, here.length)).append("}");
                text.remove_prefix(here.length + 4);
                continue;
            }
        } else if (text.front() == '{') {
            if (const auto here = placeholder_before(text.substr(1), "}"); !here.name.empty()) {
                const auto whole = text.substr(0, here.length + 2);
                filled += value_of(here.name, here.format).value_or(std::string(whole));
                text.remove_prefix(whole.size());
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
        const auto inside = text.substr(2, close - 2);
        const auto colon = std::min(inside.find(':'), inside.size());
        const auto name = trimmed(inside.substr(0, colon));
        const auto format = trimmed(inside.substr(std::min(colon + 1, inside.size())));
        if (!is_plain_name(name) || (colon < inside.size() && !format.starts_with('%')))
            throw std::invalid_argument(
                fmt::format("line {}: '{}' holds no name; a placeholder is {{{{ name }}}} or {{{{ name:%.3e }}}}, and "
                            "what is to stay "
                            "as it is belongs to \"files\"",
                            line, text.substr(0, std::min<std::size_t>(close + 2, 60))));
        filled += value_of(name, format).value_or(std::string(text.substr(0, close + 2)));
        text.remove_prefix(close + 2);
    }
}

std::optional<NumberFormat> NumberFormat::parse(std::string_view text) {
    if (!text.starts_with('%')) return std::nullopt;
    text.remove_prefix(1);
    const auto take = [&](std::string_view signs) {
        const auto length = std::min(text.find_first_not_of(signs), text.size());
        const auto taken = text.substr(0, length);
        text.remove_prefix(length);
        return taken;
    };
    const auto few = [](std::string_view digits) {
        return digits.size() < 3 && (digits.empty() || std::stoul(std::string(digits)) <= most_digits);
    };
    constexpr std::string_view digits = "0123456789";
    const auto flags = take("-+ 0#");
    const auto has = [&](char flag) { return flags.find(flag) != std::string_view::npos; };
    const auto width = take(digits);
    std::optional<std::string_view> precision;
    if (text.starts_with('.')) {
        text.remove_prefix(1);
        precision = take(digits);
    }
    const bool known = text.size() == 1 && std::string_view("eEfFgGd").find(text.front()) != std::string_view::npos;
    if (!known || !few(width) || !few(precision.value_or("")) || (precision && text == "d")) return std::nullopt;
    NumberFormat format;
    format.whole_ = text == "d";
    const auto sign = has('+') ? "+" : has(' ') ? " " : "";
    const auto zeros = has('0') && !has('-') ? "0" : "";
    const auto point = has('#') && !format.whole_ ? "#" : "";
    format.pattern_ = fmt::format("{{:{}{}{}{}{}{}{}}}",
                                  has('-')      ? "<"
                                  : *zeros != 0 ? ""
                                                : ">",
                                  sign, point, zeros, width,
                                  precision ? fmt::format(".{}", precision->empty() ? "0" : *precision) : "", text);
    return format;
}

std::string NumberFormat::operator()(double number) const {
    return whole_ ? fmt::format(fmt::runtime(pattern_), static_cast<std::int64_t>(number))
                  : fmt::format(fmt::runtime(pattern_), number);
}

std::string NumberFormat::operator()(std::uint64_t number) const {
    if (!whole_) return fmt::format(fmt::runtime(pattern_), static_cast<double>(number));
    if (!std::in_range<std::int64_t>(number)) return std::to_string(number);
    return fmt::format(fmt::runtime(pattern_), static_cast<std::int64_t>(number));
}

}  // namespace grainsweep::campaign
