// Parameter of a scene, defined once with name, unit, meaning, default and bounds. Called with a case's inputs it
// returns the value in its type.
//
//     inline constexpr Real gap{"gap", "m", "height of the lower edge over the base", 0.004, {1e-5, 0.1}};
//     info.parameters = declared(friction, gap);      const double height = gap(inputs);
#pragma once

#include "solver/scenes/values.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::kit {

/// Condition under which a parameter has an effect (Relevance); no name: always.
struct When {
    std::string_view other{};
    Relevance::Condition condition = Relevance::Condition::nonzero;
    std::array<std::string_view, 5> words{};
};

/// Conditions that must all hold.
using Conditions = std::array<When, 3>;

[[nodiscard]] constexpr When if_set(std::string_view other) {
    return {other, Relevance::Condition::nonzero, {}};
}
[[nodiscard]] constexpr When if_zero(std::string_view other) {
    return {other, Relevance::Condition::zero, {}};
}
/// Returns the condition that the other parameter is one of the words.
template <class... Word>
[[nodiscard]] constexpr When if_word(std::string_view other, Word... words) {
    return {other, Relevance::Condition::is_word, {words...}};
}

[[nodiscard]] constexpr Interval above(double low, double high) {
    return {low, high, true, false};
}

/// Returns the condition that the other parameter is a file.
[[nodiscard]] constexpr When if_file(std::string_view other) {
    return {other, Relevance::Condition::is_file, {}};
}

/// Returns the conditions that have a name, in the form of a ParameterSpec.
[[nodiscard]] std::vector<Relevance> relevance(const Conditions& conditions);
/// Returns the value of a parameter. Throws std::logic_error if the scene does not declare it.
[[nodiscard]] const Value& value_of(const Inputs& inputs, std::string_view name);

struct Real {
    std::string_view name, unit, meaning;
    double standard = 0;  ///< default value
    Interval bounds{};
    Conditions only{};

    [[nodiscard]] double operator()(const Inputs& inputs) const { return std::get<double>(value_of(inputs, name)); }
    [[nodiscard]] ParameterSpec spec() const;
    /// Returns the parameter with the default and bounds of a scene's study.
    [[nodiscard]] constexpr Real with(double its_standard, Interval its_bounds) const {
        return {name, unit, meaning, its_standard, its_bounds, only};
    }
    [[nodiscard]] constexpr Real with(std::string_view its_meaning, double its_standard, Interval its_bounds) const {
        return {name, unit, its_meaning, its_standard, its_bounds, only};
    }
};

struct Whole {
    std::string_view name, meaning;
    std::int64_t standard = 0;
    Interval bounds{};
    Conditions only{};

    [[nodiscard]] std::int64_t operator()(const Inputs& inputs) const {
        return std::get<std::int64_t>(value_of(inputs, name));
    }
    [[nodiscard]] ParameterSpec spec() const;
};

/// Word and its meaning in the program.
template <class Meant>
struct Named {
    std::string_view word;
    Meant meant{};
};

/// Parameter with a choice of words, read as their meaning; the first word is the default.
template <class Meant, std::size_t n>
struct Choice {
    std::string_view name, meaning;
    std::array<Named<Meant>, n> words{};
    Conditions only{};

    [[nodiscard]] Meant operator()(const Inputs& inputs) const {
        const auto& word = std::get<std::string>(value_of(inputs, name));
        const auto found = std::ranges::find(words, word, &Named<Meant>::word);
        if (found == words.end()) throw std::invalid_argument(std::string(name) + " knows no word '" + word + "'");
        return found->meant;
    }
    [[nodiscard]] ParameterSpec spec() const {
        std::vector<std::string> allowed;
        for (const auto& known : words) allowed.emplace_back(known.word);
        std::string first = allowed.front();
        return {std::string(name), "", std::string(meaning), std::move(first), Words{std::move(allowed)},
                relevance(only)};
    }
    [[nodiscard]] constexpr Choice with(std::string_view its_meaning) const { return {name, its_meaning, words, only}; }
};

/// Returns the contents of the file that a parameter names. Throws std::invalid_argument if it is not among the files.
[[nodiscard]] const std::string& contents_of(std::string_view name, const Inputs& inputs, const Files& files);

/// Parameter with a choice of words, read as their meaning, or a file; the first word is the default.
template <class Meant, std::size_t n>
struct ChoiceOrFile {
    std::string_view name, meaning;
    std::array<Named<Meant>, n> words{};
    Meant file{};                                        ///< meaning of a file
    void (*check)(std::string_view contents) = nullptr;  ///< throws std::invalid_argument with one sentence
    Conditions only{};

    [[nodiscard]] Meant operator()(const Inputs& inputs) const {
        if (file_word(std::get<std::string>(value_of(inputs, name)))) return file;
        return Choice<Meant, n>{name, meaning, words, only}(inputs);
    }
    [[nodiscard]] const std::string& contents(const Inputs& inputs, const Files& files) const {
        return contents_of(name, inputs, files);
    }
    [[nodiscard]] ParameterSpec spec() const {
        ParameterSpec made = Choice<Meant, n>{name, meaning, words, only}.spec();
        std::get<Words>(made.bounds).file_allowed = true;
        std::get<Words>(made.bounds).check_file = check;
        return made;
    }
};

/// Parameter that is a file, or a word for no file; the word is the default.
struct FileOr {
    std::string_view name, meaning, word;
    void (*check)(std::string_view contents) = nullptr;  ///< throws std::invalid_argument with one sentence
    Conditions only{};

    /// Returns whether a file is given.
    [[nodiscard]] bool operator()(const Inputs& inputs) const {
        return file_word(std::get<std::string>(value_of(inputs, name))).has_value();
    }
    /// Returns the contents of the file. Throws std::invalid_argument if it is not among the files.
    [[nodiscard]] const std::string& contents(const Inputs& inputs, const Files& files) const;
    [[nodiscard]] ParameterSpec spec() const;
};

template <class... Parameter>
[[nodiscard]] std::vector<ParameterSpec> declared(const Parameter&... parameters) {
    return {parameters.spec()...};
}

}  // namespace grainsweep::kit
