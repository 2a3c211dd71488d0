// Words of the field, of other programs and of other languages for what has another name here. No spelling is near: the
// search for the nearest word reads this table first.
#pragma once

#include "sweep/campaign/wrong_question.hpp"

#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// The suggestion for `word` among the names that exist where it stands, empty where the table has none. Upper and
/// lower case are told apart only between words of one letter (E and e).
[[nodiscard]] std::string synonym_of(std::string_view word, const WordList& names);

}  // namespace grainsweep::campaign
