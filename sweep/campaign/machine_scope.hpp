// What expressions in a machine file may use, and how values are read: numbers, quantities and expressions to SI
// numbers; vectors, directions, words, regions.
#pragma once

#include "solver/machine/region.hpp"
#include "solver/scenes/values.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/machine_keys.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

class MachineScope {
public:
    /// Numbers and words that expressions and texts may name.
    void set(std::string name, double value) { numbers_.insert_or_assign(std::move(name), value); }
    void set_word(std::string name, std::string word) { words_.insert_or_assign(std::move(name), std::move(word)); }
    /// The SI unit of a number, where it has one.
    void set_unit(const std::string& name, std::string unit) { units_.insert_or_assign(name, std::move(unit)); }
    /// A number that "let" defines.
    void set_let(const std::string& name, double value) { set(name, value), lets_.insert(name); }
    [[nodiscard]] bool is_let(const std::string& name) const { return lets_.contains(name); }
    [[nodiscard]] bool knows(std::string_view name) const { return numbers_.contains(name) || words_.contains(name); }

    /// A finite SI number of the unit, within the bounds. Refuses everything else.
    [[nodiscard]] double number(const Cursor& place, std::string_view unit, const Interval& bounds = {}) const;
    [[nodiscard]] double number(const Section& section, std::string_view key, std::string_view unit, double standard,
                                const Interval& bounds = {}) const;
    /// The nearest whole number of a value.
    [[nodiscard]] std::int64_t whole(const Cursor& place, const Interval& bounds) const;
    /// Whether "when" holds.
    [[nodiscard]] bool present(const Section& section) const;
    [[nodiscard]] machine::Vec3 vector(const Cursor& place, std::string_view unit) const;
    [[nodiscard]] machine::Vec3 vector(const Section& section, std::string_view key, std::string_view unit,
                                       const machine::Vec3& standard = {}) const;
    /// Of unit length.
    [[nodiscard]] machine::Vec3 direction(const Cursor& place) const;
    [[nodiscard]] machine::Vec3 direction(const Section& section, std::string_view key,
                                          const machine::Vec3& standard) const;
    /// A text with "{NAME}" replaced by a word.
    [[nodiscard]] std::string text(const Cursor& place) const;
    /// The same with numbers, too: what a check says.
    [[nodiscard]] std::string sentence(const Cursor& place) const;
    [[nodiscard]] std::string word(const Cursor& place, const WordList& words) const;
    [[nodiscard]] std::string word(const Section& section, std::string_view key, const WordList& words,
                                   std::string_view standard) const;
    [[nodiscard]] machine::Region region(const Cursor& place) const;
    /// One of the names, as its place in the list.
    [[nodiscard]] std::size_t place_in(const Cursor& place, const std::vector<std::string>& names,
                                       std::string_view what) const;
    /// One of them or a list of them, without repeats.
    [[nodiscard]] std::vector<std::size_t> places_in(const Cursor& place, const std::vector<std::string>& names,
                                                     std::string_view what) const;

    [[nodiscard]] std::vector<std::string> names() const;
    /// Of a name that is known, which may be without a value.
    [[nodiscard]] double value(std::string_view name) const { return numbers_.find(name)->second; }

private:
    std::map<std::string, double, std::less<>> numbers_;
    std::map<std::string, std::string, std::less<>> words_;
    std::set<std::string> lets_;
    std::map<std::string, std::string, std::less<>> units_;

    void require_unit(const Cursor& place, const std::string& name, std::string_view unit) const;
    [[noreturn]] void refuse_expression(const Cursor& place, const std::string& text, const std::string& why) const;
};

/// Whether a text begins as a number with or without a unit behind it, not as an expression.
[[nodiscard]] bool is_quantity(std::string_view text);
/// The one key of an object among the forms; refuses none and several.
[[nodiscard]] std::optional<std::size_t> form_of(const Json& object, std::span<const machine_keys::Form> forms);

}  // namespace grainsweep::campaign
