// A question that cannot be asked: where, what value, which rule, the nearest right word. Exit code 2.
#pragma once

#include <filesystem>
#include <iterator>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

class WrongQuestion : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// "path: got value; rule. Did you mean 'x'?"
[[nodiscard]] WrongQuestion wrong_question(std::string_view where, std::string_view value, std::string_view rule,
                                           std::string_view suggestion = {});

/// What `ask` answers; its WrongQuestion names the file before the path within it.
template <class Ask>
auto asked_in(const std::filesystem::path& file, const Ask& ask) {
    try {
        return ask();
    } catch (const WrongQuestion& wrong) {
        throw WrongQuestion(file.string() + ": " + wrong.what());
    }
}

/// Names that somebody else holds, for the length of a call.
class WordList : public std::vector<std::string_view> {
public:
    template <class Range>
    WordList(const Range& range)  // NOLINT(google-explicit-constructor)
        : vector(std::begin(range), std::end(range)) {}
};

/// Those of things that have one.
template <class Things>
[[nodiscard]] WordList names_of(const Things& things) {
    return std::views::transform(things, [](const auto& thing) { return std::string_view(thing.name); });
}

/// The names, separated by commas; "none" where there are none.
[[nodiscard]] std::string listed(const WordList& names);

/// Returns a suggestion for `word`: the candidate it is a synonym of (synonyms.hpp), else the one with the smallest
/// edit distance, else the only one with `word` between its underscores. Empty where none is near.
[[nodiscard]] std::string nearest_word(std::string_view word, const WordList& candidates);

}  // namespace grainsweep::campaign
