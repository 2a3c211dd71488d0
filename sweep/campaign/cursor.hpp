// Reading of JSON with paths: every refusal names the path, the value, the rule and the nearest word.
#pragma once

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/keys.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

/// JSON value and its path. It refers to the document, which must outlive it.
class Cursor {
public:
    Cursor(const Json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[nodiscard]] const Json& json() const { return *value_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] Cursor operator[](std::size_t index) const { return {(*value_)[index], path_of(path_, index)}; }
    [[nodiscard]] Cursor operator[](std::string_view key) const { return {value_->at(key), path_of(path_, key)}; }

    [[noreturn]] void refuse(std::string_view rule, std::string_view suggestion = {}) const;

    /// Returns a finite number within the interval.
    [[nodiscard]] double number(const Interval& bounds = {}) const;
    /// Returns a whole number within the interval; 1e4 is one.
    [[nodiscard]] std::int64_t whole(const Interval& bounds = {}) const;
    [[nodiscard]] bool flag() const;
    /// Returns a non-empty text.
    [[nodiscard]] std::string text() const;
    /// Returns one of the words.
    [[nodiscard]] std::string word(const WordList& words) const;
    /// Returns the elements of a list; refuses other values.
    [[nodiscard]] std::vector<Cursor> elements() const;
    /// Returns the members of an object without its notes, which are checked; refuses other values with the rule.
    [[nodiscard]] std::vector<std::pair<std::string, Cursor>> members(std::string_view rule) const;

private:
    const Json* value_;
    std::string path_;
};

/// Object with the keys of a table, and "notes".
class Section {
public:
    /// Refuses a value that is no object, unknown keys, and missing required keys.
    Section(Cursor place, std::span<const Field> keys);

    [[nodiscard]] const Cursor& place() const { return place_; }
    [[nodiscard]] std::optional<Cursor> find(std::string_view key) const;
    /// Returns the value of a required key.
    [[nodiscard]] Cursor at(std::string_view key) const;

    /// Returns the keys of the object, or of the entries, at a key.
    [[nodiscard]] std::span<const Field> members(std::string_view key) const { return row(key).members; }

    // Return the value of a key, checked against its row of the table; `standard` if it is absent.
    [[nodiscard]] double number(std::string_view key, double standard) const;
    [[nodiscard]] std::int64_t whole(std::string_view key, std::int64_t standard) const;
    /// Returns the same for a key that may also be a word, which means `of_word`.
    [[nodiscard]] std::int64_t whole_or_word(std::string_view key, std::int64_t standard, std::int64_t of_word) const;
    [[nodiscard]] bool flag(std::string_view key, bool standard) const;
    [[nodiscard]] std::string word(std::string_view key, std::string_view standard) const;
    [[nodiscard]] std::vector<std::string> words(std::string_view key, const std::vector<std::string>& standard) const;

private:
    [[nodiscard]] const Field& row(std::string_view key) const;

    Cursor place_;
    std::span<const Field> keys_;
};

/// Returns the interval in words, such as "a number from 0 to 1" or "a number above 0".
[[nodiscard]] std::string in_words(const Interval& bounds);
/// Returns the words as "'a', 'b' or 'c'".
[[nodiscard]] std::string in_words(const WordList& words);

}  // namespace grainsweep::campaign
