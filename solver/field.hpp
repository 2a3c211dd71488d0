// Field: a member of a type that a file sets or a command prints, as a row. A type has an array of fields, a variant an
// array of named alternatives. Readers, schemas and reference tables are functions over these arrays, and no templates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

namespace grainsweep {

/// Allowed numbers: low <= x <= high, without an open end.
struct Interval {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;
    bool high_open = false;

    [[nodiscard]] bool contains(double x) const {
        return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
    }
};

inline constexpr Interval positive_number{0, std::numeric_limits<double>::infinity(), true, true};
inline constexpr Interval no_negative_number{0, std::numeric_limits<double>::infinity(), false, true};

struct Field {
    /// quantity: a number, a text with a unit, or an expression; value: any JSON value, which its reader checks;
    /// particles: species, or single particles by name; named: an object of entries by name.
    enum class Kind {
        text,
        word,
        words,
        whole,
        number,
        flag,
        quantity,
        vector,
        direction,
        region,
        species,
        particles,
        walls,
        value,
        object,
        array,
        named
    };
    std::string_view name;
    Kind kind = Kind::text;
    std::string_view meaning;
    std::string_view standard = {};  ///< JSON text of the default; empty: none, or that of a default object
    Interval bounds = {};            ///< of whole, number and quantity
    /// For word and words: the words; for whole: words that are also allowed. Of words, one that ends with a colon is
    /// the beginning of a text.
    std::span<const std::string_view> words = {};
    bool required = false;
    std::string_view unit = {};           ///< of quantity and vector, the SI unit; of a result its own
    void* (*at)(void* object) = nullptr;  ///< member of the object; null: the reader of the object takes the value
    void (*choose)(void* object, std::size_t word) = nullptr;  ///< sets a member to a word of `words`
    bool optional = false;  ///< the member is std::optional, and empty by default; some results do not have the key
    std::span<const Field> members = {};  ///< fields of an object, or of the entries of array and named
};

/// Type that a file sets: its fields, and an object with the defaults.
struct Type {
    std::string_view name, meaning;
    std::span<const Field> fields;
    const void* (*initial)() = nullptr;      ///< null: every default is a text
    void* (*make)(void* variant) = nullptr;  ///< of an alternative: makes a variant hold its default and returns it
};

[[nodiscard]] constexpr Field needed(Field field) {
    field.required = true;
    return field;
}

/// Returns the field with the fields of its object or entries.
[[nodiscard]] constexpr Field holding(Field field, std::span<const Field> members) {
    field.members = members;
    return field;
}

namespace fields {

template <class>
struct Member;
template <class Object_, class Value_>
struct Member<Value_ Object_::*> {
    using Object = Object_;
    using Value = Value_;
};
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// Returns the address of a member; an optional one is made first.
template <auto member>
void* at(void* object) {
    auto& value = static_cast<typename Member<decltype(member)>::Object*>(object)->*member;
    if constexpr (is_optional<std::remove_reference_t<decltype(value)>>)
        return &value.emplace();
    else
        return &value;
}

template <auto member>
[[nodiscard]] constexpr Field quantity(std::string_view name, std::string_view unit, std::string_view meaning,
                                       Interval bounds = {}) {
    Field field{name, Field::Kind::quantity, meaning, {}, bounds, {}, false, unit, at<member>};
    field.optional = is_optional<typename Member<decltype(member)>::Value>;
    return field;
}

/// Returns the row of a member [x, y, z].
template <auto member>
[[nodiscard]] constexpr Field vector(std::string_view name, std::string_view unit, std::string_view meaning) {
    return {name, Field::Kind::vector, meaning, {}, {}, {}, false, unit, at<member>};
}

/// Returns the row of a member [x, y, z] that the reader makes of unit length.
template <auto member>
[[nodiscard]] constexpr Field direction(std::string_view name, std::string_view meaning) {
    return {name, Field::Kind::direction, meaning, {}, {}, {}, false, {}, at<member>};
}

/// Returns the row of a region (solver/machine/region.hpp), which a file names by its form.
template <auto member>
[[nodiscard]] constexpr Field region(std::string_view name, std::string_view meaning) {
    return {name, Field::Kind::region, meaning, {}, {}, {}, false, {}, at<member>};
}

template <auto member>
[[nodiscard]] constexpr Field flag(std::string_view name, std::string_view meaning) {
    return {name, Field::Kind::flag, meaning, {}, {}, {}, false, {}, at<member>};
}

/// Returns the row of an enumeration, whose words have the order of its values.
template <auto member>
[[nodiscard]] constexpr Field choice(std::string_view name, std::string_view meaning,
                                     std::span<const std::string_view> words, std::string_view standard) {
    using Of = Member<decltype(member)>;
    Field field{name, Field::Kind::word, meaning, standard, {}, words};
    field.choose = [](void* object, std::size_t word) {
        static_cast<typename Of::Object*>(object)->*member = static_cast<typename Of::Value>(word);
    };
    return field;
}

template <class T>
const void* initial() {
    static const T object{};
    return &object;
}

/// Returns the alternative of a variant that holds a T.
template <class Variant, class T>
[[nodiscard]] constexpr Type alternative(std::string_view name, std::string_view meaning,
                                         std::span<const Field> of = {}) {
    return {name, meaning, of, initial<T>,
            [](void* variant) -> void* { return &static_cast<Variant*>(variant)->template emplace<T>(); }};
}

}  // namespace fields
}  // namespace grainsweep
