// Fields in words, for reference tables and schemas.
#pragma once

#include "solver/field.hpp"

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Returns the JSON text of the default of a field; empty: it has none. Defaults that no text states are those of the
/// type's default object.
[[nodiscard]] std::string default_text(const Type& type, const Field& field);
/// Returns the meaning with the unit.
[[nodiscard]] std::string meaning_text(const Field& field);
/// Returns the word for a kind of value.
[[nodiscard]] std::string_view kind_word(Field::Kind kind);

}  // namespace grainsweep::campaign
