// Names for expressions in a machine file, and reading of values: numbers, quantities and expressions as SI numbers;
// vectors, directions, words, regions.
#pragma once

#include "solver/machine/region.hpp"
#include "solver/scenes/values.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine_keys.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

class MachineScope {
public:
    /// Set numbers and words that expressions and texts may name.
    void set(std::string name, double value) { numbers_.insert_or_assign(std::move(name), value); }
    void set_word(std::string name, std::string word) { words_.insert_or_assign(std::move(name), std::move(word)); }
    /// Sets the SI unit of a number, if it has one.
    void set_unit(const std::string& name, std::string unit) { units_.insert_or_assign(name, std::move(unit)); }
    /// Sets a number that "let" defines.
    void set_let(const std::string& name, double value) { set(name, value), lets_.insert(name); }
    /// Sets the contents of a file, by the name in the document or the value of a parameter.
    void set_file(const std::string& name, std::string_view contents) { files_.insert_or_assign(name, contents); }
    /// Returns the contents of a file that a text names.
    [[nodiscard]] std::string_view contents(const Cursor& place) const;
    /// Sets the number of a wall, by which regions name it; none: this case is without it.
    void set_wall(std::string name, std::optional<std::size_t> number) {
        walls_.insert_or_assign(std::move(name), number);
    }
    [[nodiscard]] bool is_let(const std::string& name) const { return lets_.contains(name); }
    [[nodiscard]] bool has_number(std::string_view name) const { return numbers_.contains(name); }
    [[nodiscard]] bool knows(std::string_view name) const { return numbers_.contains(name) || words_.contains(name); }

    /// Returns a finite SI number of the unit within the bounds. Refuses other values.
    [[nodiscard]] double number(const Cursor& place, std::string_view unit, const Interval& bounds = {}) const;
    [[nodiscard]] double number(const Section& section, std::string_view key, std::string_view unit, double standard,
                                const Interval& bounds = {}) const;
    /// Returns the nearest whole number of an expression's value; a number must be a whole one.
    [[nodiscard]] std::int64_t whole(const Cursor& place, const Interval& bounds) const;
    /// Returns whether "when" holds.
    [[nodiscard]] bool present(const Section& section) const;
    [[nodiscard]] machine::Vec3 vector(const Cursor& place, std::string_view unit) const;
    [[nodiscard]] machine::Vec3 vector(const Section& section, std::string_view key, std::string_view unit,
                                       const machine::Vec3& standard = {}) const;
    /// Returns a vector of unit length.
    [[nodiscard]] machine::Vec3 direction(const Cursor& place) const;
    [[nodiscard]] machine::Vec3 direction(const Section& section, std::string_view key,
                                          const machine::Vec3& standard) const;
    /// Returns a text with "{NAME}" replaced by words.
    [[nodiscard]] std::string text(const Cursor& place) const;
    /// Returns a text with words and numbers replaced, for the message of a check.
    [[nodiscard]] std::string sentence(const Cursor& place) const;
    [[nodiscard]] std::string word(const Cursor& place, const WordList& words) const;
    [[nodiscard]] std::string word(const Section& section, std::string_view key, const WordList& words,
                                   std::string_view standard) const;
    [[nodiscard]] machine::Region region(const Cursor& place) const;
    /// Returns the number of a wall; of a list, of the first one that there is.
    [[nodiscard]] std::size_t wall(const Cursor& place) const;
    /// Returns the index of one of the names.
    [[nodiscard]] std::size_t place_in(const Cursor& place, const std::vector<std::string>& names,
                                       std::string_view what) const;
    /// Returns the indices of one name or a list of names, without repeats.
    [[nodiscard]] std::vector<std::size_t> places_in(const Cursor& place, const std::vector<std::string>& names,
                                                     std::string_view what) const;

    /// Reads the fields of a section that have a place in an object; absent ones keep their value.
    void read(const Section& section, std::span<const Field> fields, void* object) const;
    /// Reads the object at a key, if it is there, by the fields of its row; returns it.
    std::optional<Section> read(const Section& section, std::string_view key, void* object) const;
    /// Makes a variant hold the alternative that a value names as its only key, and reads its fields. Refuses other
    /// values with the rule.
    const Type& read_alternative(const Cursor& place, std::span<const Type> types, void* variant,
                                 std::string_view rule) const;

    [[nodiscard]] std::vector<std::string> names() const;
    /// Returns the value of a known name, which may be undefined.
    [[nodiscard]] double value(std::string_view name) const { return numbers_.find(name)->second; }

private:
    std::map<std::string, double, std::less<>> numbers_;
    std::map<std::string, std::string, std::less<>> words_;
    std::set<std::string> lets_;
    std::map<std::string, std::string, std::less<>> units_;
    std::map<std::string, std::optional<std::size_t>, std::less<>> walls_;
    std::map<std::string, std::string_view, std::less<>> files_;

    [[nodiscard]] std::variant<Formula, std::string> parsed_here(const std::string& text) const;
    void require_unit(const Cursor& place, const std::string& name, std::string_view unit) const;
    [[noreturn]] void refuse_expression(const Cursor& place, const std::string& text, const std::string& why) const;
};

/// What a text says whatever the numbers in it are.
struct ValueText {
    std::string given;             ///< the text, with quantities within expressions as SI numbers
    std::string unclear, pointed;  ///< corrections (unclear_quotient, with_decimal_point); empty: none
    bool quantity = false;         ///< one number with or without a unit
};

/// Returns a text where a unit is wanted. Quantities become SI numbers where expressions calculate in it. Remembers
/// it.
[[nodiscard]] std::shared_ptr<const ValueText> value_text(const std::string& written, std::string_view unit = "1");
/// Returns whether a text is a number with or without a unit, not an expression.
[[nodiscard]] bool is_quantity(std::string_view text);
/// Returns the only type whose name is a key of the object; null: none or several.
[[nodiscard]] const Type* named_in(const Json& object, std::span<const Type> types);

}  // namespace grainsweep::campaign
