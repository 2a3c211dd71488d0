#include "sweep/campaign/input_error.hpp"

#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/synonyms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <limits>

namespace grainsweep::campaign {

namespace {

constexpr std::size_t longest_value = 400;  // bytes
constexpr std::size_t longest_word = 64;    // longer ones are no misspelling of a name of ours

/// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours, case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t columns = b.size() + 1;
    std::vector<std::size_t> table((a.size() + 1) * columns);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return table[i * columns + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
    for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = small_letter(a[i - 1]) == small_letter(b[j - 1]);
            std::size_t best = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (same ? 0U : 1U)});
            if (i > 1 && j > 1 && small_letter(a[i - 1]) == small_letter(b[j - 2]) &&
                small_letter(a[i - 2]) == small_letter(b[j - 1])) {
                best = std::min(best, at(i - 2, j - 2) + 1);
            }
            at(i, j) = best;
        }
    }
    return at(a.size(), b.size());
}

/// Returns the only candidate that has `word` as one of its parts between underscores; empty if there is none or
/// several.
std::string named_by_a_part(std::string_view word, const WordList& candidates) {
    std::string only;
    for (const auto candidate : candidates) {
        const std::string parts = fmt::format("_{}_", candidate);
        if (parts.find(fmt::format("_{}_", word)) == std::string::npos) continue;
        if (!only.empty()) return {};
        only = candidate;
    }
    return only;
}

/// Returns the beginning of a text, cut between two characters of UTF-8. The text may be a whole file.
std::string_view beginning(std::string_view text) {
    if (text.size() <= longest_value) return text;
    std::size_t end = longest_value;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    return text.substr(0, end);
}

/// One line that moves no cursor of a terminal: white space as blanks, other control characters by their number.
std::string single_line(std::string_view text) {
    std::string line;
    line.reserve(text.size());
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (std::isspace(code) != 0)
            line += ' ';
        else if (code < 0x20U || code == 0x7FU)
            line += fmt::format("\\u{:04x}", static_cast<unsigned>(code));
        else
            line += c;
    }
    return line;
}

}  // namespace

InputError input_error(std::string_view where, std::string_view value, std::string_view rule,
                       std::string_view suggestion) {
    std::string sentence(where);
    if (!sentence.empty()) sentence += ": ";
    const auto start = beginning(value);
    if (!value.empty()) sentence += fmt::format("got {}{}; ", start, start.size() < value.size() ? " ..." : "");
    sentence += rule;
    if (!sentence.ends_with('.')) sentence += '.';
    if (!suggestion.empty()) sentence += fmt::format(" Did you mean '{}'?", suggestion);
    return InputError(single_line(sentence));
}

std::string listed(const WordList& names) {
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string nearest_word(std::string_view word, const WordList& candidates) {
    if (word.empty() || word.size() > longest_word) return {};
    std::string nearest = synonym_of(word, candidates);
    if (!nearest.empty()) return nearest;
    std::size_t smallest = std::numeric_limits<std::size_t>::max();
    for (const auto candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        const std::size_t tolerated = std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
        if (distance < smallest && distance <= tolerated) {
            smallest = distance;
            nearest = candidate;
        }
    }
    return nearest.empty() ? named_by_a_part(word, candidates) : nearest;
}

}  // namespace grainsweep::campaign
