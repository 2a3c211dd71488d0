// A question that cannot be asked: where, what value, which rule, the nearest right word. Exit code 2.
#pragma once

#include <filesystem>
#include <span>
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

/// The names, separated by commas; "none" where there are none.
[[nodiscard]] std::string listed(std::span<const std::string> names);

/// What to suggest for `word`: the candidate it is a synonym of (synonyms.hpp), else the one with the smallest edit
/// distance, else the only one that has `word` between its underscores; empty where none is near.
[[nodiscard]] std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

}  // namespace grainsweep::campaign
