// Words, numbers and sizes in single cells of an export.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace grainsweep::campaign {
namespace {

using SizeKind = ExportSize::Kind;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Digits without marks of thousands: "1.234,5" and "1 234,5" with decimal commas. A mark counts only beside a decimal
/// sign or as a blank, because "1,400" alone may be 1.4.
std::optional<std::string> without_thousands(std::string_view digits, char mark) {
    const auto first = digits.find(mark);
    if (first == std::string_view::npos) return std::string(digits);
    if (first == 0 || first > 3 || !is_digit(digits.front()) || digits.front() == '0') return std::nullopt;
    std::string plain(digits.substr(0, first));
    std::size_t at = first;
    while (at < digits.size() && digits[at] == mark) {
        const auto group = digits.substr(at + 1, 3);
        if (group.size() != 3 || !std::ranges::all_of(group, is_digit)) return std::nullopt;
        plain += group;
        at += 4;
    }
    const auto rest = digits.substr(std::min(at, digits.size()));
    if ((mark != ' ' && rest.empty()) || (!rest.empty() && is_digit(rest.front()))) return std::nullopt;
    return plain + std::string(rest);
}

std::optional<double> value_of_digits(std::string_view digits, bool decimal_comma) {
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::string plain;
    const char mark = decimal_comma ? '.' : ',';
    if (digits.find(mark) != std::string_view::npos) {
        auto without = without_thousands(digits, mark);
        if (!without) return std::nullopt;
        plain = std::move(*without);
    } else {
        plain = digits;
    }
    if (decimal_comma) std::ranges::replace(plain, ',', '.');
    return number_in(plain);
}

/// A whole word as one of a list; the words are apart by blanks.
bool is_one_of(std::string_view word, std::string_view list) {
    const auto at = (" " + std::string(list) + " ").find(" " + std::string(word) + " ");
    return !word.empty() && word.find(' ') == std::string_view::npos && at != std::string::npos;
}

/// Removes one of the words from the front, and blanks behind it.
bool drop_front(std::string& text, std::initializer_list<std::string_view> words) {
    for (const auto word : words)
        if (text.starts_with(word)) {
            text = std::string(trimmed(std::string_view(text).substr(word.size())));
            return true;
        }
    return false;
}

bool drop_back(std::string& text, std::initializer_list<std::string_view> words) {
    for (const auto word : words)
        if (text.size() > word.size() && text.ends_with(word)) {
            text = std::string(trimmed(std::string_view(text).substr(0, text.size() - word.size())));
            return true;
        }
    return false;
}

/// "3/8" and "1 1/2" and "1-1/2": halves to sixty-fourths of an inch.
std::optional<double> inch_fraction(std::string_view text) {
    const auto slash = text.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    const auto before = text.substr(0, slash);
    const auto blank = before.find_last_of(" -");
    const auto whole =
        blank == std::string_view::npos ? std::optional(0.0) : number_in(trimmed(before.substr(0, blank)));
    const auto above = number_in(trimmed(before.substr(blank == std::string_view::npos ? 0 : blank + 1)));
    const auto below = number_in(trimmed(text.substr(slash + 1)));
    constexpr std::array<double, 6> parts = {2, 4, 8, 16, 32, 64};
    if (!whole || !above || !below || std::ranges::find(parts, *below) == parts.end()) return std::nullopt;
    if (!(*above >= 1 && *above < *below) || std::fmod(*above, 2) == 0 || *whole < 0) return std::nullopt;
    return *whole + *above / *below;
}

/// Number of a sieve, or a size in inches, by the signs of either.
std::optional<ExportSize> sieve_name(std::string text, bool decimal_comma) {
    const bool inches = drop_back(text, {"inches", "inch", "in.", " in", "\"", "''"});
    bool number = drop_front(text, {"u.s. standard", "us standard", "u.s.", "astm", "tyler", "us "});
    number = drop_front(text, {"sieve no.", "sieve no", "no.", "no ", "nr.", "nr ", "#", "mesh"}) || number;
    number = drop_back(text, {"mesh", "#"}) || number;
    if (const auto fraction = inch_fraction(text)) return ExportSize{SizeKind::point, *fraction, *fraction, "in"};
    if (text.empty() || inches == number) return std::nullopt;
    if (const auto value = value_of_digits(text, decimal_comma); value && *value > 0)
        return ExportSize{SizeKind::point, *value, *value, inches ? "in" : "mesh", text.starts_with('+')};
    return std::nullopt;
}

/// Two sizes with a sign or word between: "20-45", "20 to 45", "0,5/1,0", "-40+60".
std::optional<ExportSize> size_range(std::string_view text, bool decimal_comma) {
    const auto part = [&](std::string_view word) { return export_number(trimmed(word), decimal_comma); };
    const auto range = [&](std::string_view first, std::string_view second) -> std::optional<ExportSize> {
        const auto low = part(first), high = part(second);
        if (!low || !high || low->value == high->value || low->unit == "%" || high->unit == "%") return std::nullopt;
        return ExportSize{SizeKind::range, std::min(low->value, high->value), std::max(low->value, high->value),
                          high->unit.empty() ? low->unit : high->unit};
    };
    if (text.starts_with('-') || text.starts_with('+')) {
        const auto second = text.find(text.front() == '-' ? '+' : '-', 1);
        if (second != std::string_view::npos)
            if (auto found = range(text.substr(1, second - 1), text.substr(second + 1))) return found;
    }
    for (const std::string_view between : {" to ", " bis ", " a ", "...", "\xE2\x80\xA6", "x", "/"})
        if (const auto at = text.find(between); at != std::string_view::npos && at > 0)
            if (auto found = range(text.substr(0, at), text.substr(at + between.size()))) return found;
    for (std::size_t dash = text.find('-', 1); dash != std::string_view::npos; dash = text.find('-', dash + 1))
        if (auto found = range(text.substr(0, dash), text.substr(dash + 1))) return found;
    return std::nullopt;
}

}  // namespace

std::string plain_words(std::string_view text) {
    constexpr auto letters = std::to_array<std::pair<std::string_view, std::string_view>>(
        {{"\xC3\x82\xC2\xB5", "u"}, {"\xC3\x8E\xC2\xBC", "u"},                       // UTF-8 that was read as Latin-1
         {"\xC2\xB5", "u"},         {"\xCE\xBC", "u"},         {"\xC3\xA6m", "um"},  // a micro sign of code page 850
         {"\xC3\xA4", "ae"},        {"\xC3\x84", "ae"},        {"\xC3\xB6", "oe"},     {"\xC3\x96", "oe"},
         {"\xC3\xBC", "ue"},        {"\xC3\x9C", "ue"},        {"\xC3\x9F", "ss"},     {"\xC3\xA0", "a"},
         {"\xC3\xA1", "a"},         {"\xC3\xA2", "a"},         {"\xC3\xA8", "e"},      {"\xC3\xA9", "e"},
         {"\xC3\x89", "e"},         {"\xC3\xAA", "e"},         {"\xC3\xAD", "i"},      {"\xC3\xB1", "n"},
         {"\xC3\xB3", "o"},         {"\xC3\xA7", "c"},         {"\xCF\x86", "phi"},    {"\xCF\x95", "phi"},
         {"\xCE\xA6", "phi"},       {"\xE2\x89\xA4", "<"},     {"\xE2\x89\xA5", ">"},  {"\xE2\x80\x90", "-"},
         {"\xE2\x80\x91", "-"},     {"\xE2\x80\x93", "-"},     {"\xE2\x80\x94", "-"},  {"\xE2\x88\x92", "-"},
         {"\xC3\xB7", "-"},         {"\xE2\x80\x9C", "\""},    {"\xE2\x80\x9D", "\""}, {"\xE2\x80\xB3", "\""},
         {"\xC2\xB2", "2"},         {"\xC2\xB3", "3"},         {"\xE2\x82\x80", "0"},  {"\xE2\x82\x82", "2"},
         {"\xE2\x82\x83", "3"},     {"\xE2\x80\xAF", " "},     {"\xC2\xA0", " "}});
    std::string plain;
    plain.reserve(text.size());
    while (!text.empty()) {
        if (static_cast<unsigned char>(text.front()) < 0x80U) {
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
            text.remove_prefix(1);
            continue;
        }
        const auto* const found =
            std::ranges::find_if(letters, [&](const auto& one) { return text.starts_with(one.first); });
        if (found != letters.end()) {
            plain += found->second;
            text.remove_prefix(found->first.size());
        } else {
            plain += text.front();
            text.remove_prefix(1);
        }
    }
    return plain;
}

std::string length_unit(std::string_view word) {
    if (is_one_of(word, "um mm nm m cm")) return std::string(word);
    if (is_one_of(word,
                  "micron microns micrometer micrometers micrometre micrometres mikrometer mikron mum mkm ?m "
                  "\xEF\xBF\xBDm d.um"))
        return "um";
    if (is_one_of(word, "millimeter millimeters millimetre millimetres")) return "mm";
    if (is_one_of(word, "nanometer nanometers nanometre nanometres d.nm")) return "nm";
    if (is_one_of(word, "inch inches in. in \"")) return "in";
    return {};
}

std::optional<ExportNumber> export_number(std::string_view cell, bool decimal_comma) {
    const std::string_view word = trimmed(cell);
    constexpr std::string_view of_numbers = "0123456789.,+-eE";
    if (word.empty()) return std::nullopt;
    const auto lead = static_cast<unsigned char>(word.front());
    if (lead < 0x80U && of_numbers.substr(0, 14).find(word.front()) == std::string_view::npos) return std::nullopt;
    if (word.find_first_not_of(of_numbers) == std::string_view::npos) {
        const auto value = value_of_digits(word, decimal_comma);
        return value ? std::optional(ExportNumber{*value, {}}) : std::nullopt;
    }
    std::string text = plain_words(word);
    if (const auto blank = text.find(' ');
        blank != std::string::npos && blank + 1 < text.size() && is_digit(text[blank + 1])) {
        const auto end = std::min(text.find_first_not_of("0123456789., "), text.size());
        const auto digits = without_thousands(trimmed(std::string_view(text).substr(0, end)), ' ');
        if (!digits) return std::nullopt;
        text = *digits + text.substr(end);
    }
    auto end = std::min(text.find_first_not_of("0123456789.,+-e"), text.size());
    while (end > 0 && text[end - 1] == 'e') --end;
    const auto value = value_of_digits(std::string_view(text).substr(0, end), decimal_comma);
    if (!value) return std::nullopt;
    const std::string unit(trimmed(std::string_view(text).substr(end)));
    if (is_one_of(unit, "% g kg mg vol% vol.% wt% phi") || unit.empty()) return ExportNumber{*value, unit};
    const std::string length = length_unit(unit);
    if (length.empty() || length == "in") return std::nullopt;
    return ExportNumber{*value, length};
}

std::optional<ExportSize> export_size(std::string_view cell, bool decimal_comma) {
    std::string text = plain_words(trimmed(cell));
    constexpr auto pans =
        std::to_array<std::string_view>({"pan", "base", "bottom", "receiver", "boden", "tray", "fond", "bottom pan",
                                         "siebboden", "schale", "auffangschale", "siebpfanne", "pfanne",
                                         "receiving pan", "collector", "fondo", "fines", "rest", "bottom plate"});
    if (std::ranges::find(pans, text) != pans.end()) return ExportSize{SizeKind::pan, 0, 0, {}};
    if (const auto number = export_number(text, decimal_comma)) {
        if (number->unit == "%") return std::nullopt;
        ExportSize size{SizeKind::point, number->value, number->value, number->unit};
        size.retained_on = text.starts_with('+');
        return size;
    }
    if (text.size() > 40) return std::nullopt;
    const auto limit = [&](SizeKind kind) -> std::optional<ExportSize> {
        auto size = export_size(text, decimal_comma);
        if (!size || size->kind != SizeKind::point) return std::nullopt;
        size->kind = kind;
        return size;
    };
    if (drop_front(text, {"<=", "<", "unter ", "below ", "under ", "less than ", "finer than ", "kleiner "}))
        return limit(SizeKind::below);
    if (drop_front(text, {">=", ">", "ueber ", "above ", "over ", "greater than ", "larger than ", "groesser "}))
        return limit(SizeKind::above);
    if (auto sieve = sieve_name(text, decimal_comma)) return sieve;
    const bool mesh = drop_back(text, {"mesh", "#"}) || drop_front(text, {"mesh"});
    auto range = size_range(text, decimal_comma);
    if (mesh && range) range->unit = "mesh";
    if (range) return range;
    if (mesh && (text.starts_with('+') || text.starts_with('-')))
        if (const auto number = export_number(text, decimal_comma)) {
            ExportSize size{SizeKind::point, number->value, number->value, "mesh"};
            size.retained_on = text.starts_with('+');
            return size;
        }
    return std::nullopt;
}

std::optional<double> number_at(const ExportGrid& grid, std::size_t row, std::size_t column) {
    const auto number = export_number(grid.rows[row][column], grid.decimal_comma);
    return number ? std::optional(number->value) : std::nullopt;
}

bool has_word(std::string_view text, std::span<const std::string_view> words) {
    return std::ranges::any_of(words, [&](auto word) { return text.find(word) != std::string_view::npos; });
}

void refuse_export(const std::string& why) {
    throw input_error("EXPORT", "", why);
}

}  // namespace grainsweep::campaign
