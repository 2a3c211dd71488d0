// Synonyms from the field, other programs and other languages, whose spelling is not near the word used here. The
// search for the nearest word uses this table first.
#pragma once

#include "sweep/campaign/input_error.hpp"

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Returns the suggestion for `word` among the names that are valid at its place; empty if the table has none. Case
/// matters only for words of one letter (E and e).
[[nodiscard]] std::string synonym_of(std::string_view word, const WordList& names);

}  // namespace grainsweep::campaign
