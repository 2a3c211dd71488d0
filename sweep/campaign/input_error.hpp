// Error of a user's input, with place, value, rule and the nearest valid word. Exit code 2.
#pragma once

#include <filesystem>
#include <iterator>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns the error "path: got value; rule. Did you mean 'x'?".
[[nodiscard]] InputError input_error(std::string_view where, std::string_view value, std::string_view rule,
                                     std::string_view suggestion = {});

/// Returns the result of `ask`; adds the file to its InputError, before the path.
template <class Ask>
auto asked_in(const std::filesystem::path& file, const Ask& ask) {
    try {
        return ask();
    } catch (const InputError& wrong) {
        throw InputError(file.string() + ": " + wrong.what());
    }
}

/// List of names that others own, for the duration of a call.
class WordList : public std::vector<std::string_view> {
public:
    template <class Range>
    WordList(const Range& range)  // NOLINT(google-explicit-constructor)
        : vector(std::begin(range), std::end(range)) {}
};

/// Returns the names of things with a name.
template <class Things>
[[nodiscard]] WordList names_of(const Things& things) {
    return std::views::transform(things, [](const auto& thing) { return std::string_view(thing.name); });
}

/// Returns the names, separated by commas; "none" if there are none.
[[nodiscard]] std::string listed(const WordList& names);

/// Returns a suggestion for `word`: by the table of synonyms (synonyms.hpp), else the candidate with the smallest edit
/// distance, else the only one with `word` between its underscores. Empty if none is near.
[[nodiscard]] std::string nearest_word(std::string_view word, const WordList& candidates);

}  // namespace grainsweep::campaign
