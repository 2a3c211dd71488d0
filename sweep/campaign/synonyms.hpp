// Words of the field, of other programs and of other languages for what has another name here. No spelling is near:
// the search for the nearest word asks this table first.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

struct Synonym {
    std::string_view word;        ///< what is written elsewhere
    std::string_view name;        ///< what it is called here
    std::string_view shown = {};  ///< how the name is used, where it alone would mislead; empty: as it is
};

/// The suggestion for `word` among the names that exist where it stands, empty where the table has none. Upper and
/// lower case are told apart only between words of one letter (E and e).
[[nodiscard]] std::string synonym_of(std::string_view word, std::span<const std::string> names);

}  // namespace grainsweep::campaign
