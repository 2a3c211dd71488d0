// From text to JSON, strictly: a key twice, NaN, Infinity, a number beyond double, a comment, bytes that are
// not UTF-8 and nesting no campaign needs are refused, each with its place.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace grainsweep::campaign {

using Json = nlohmann::json;

/// Throws WrongQuestion: at "line L, column C" where the text is no JSON; at the JSON path of a repeated key, of a text
/// with NUL, or of nesting deeper than 32. A UTF-8 byte-order mark is
/// skipped.
[[nodiscard]] Json parse_json(std::string_view text);

/// A value as a message shows it: compact JSON in printable ASCII, shortened to about 60 characters.
[[nodiscard]] std::string shown(const Json& value);

/// "$.factors" and "speed" -> "$.factors.speed"; a key that is no plain word is put as ["key"].
[[nodiscard]] std::string path_of(std::string_view parent, std::string_view key);
/// "$.factors" and 1 -> "$.factors[1]".
[[nodiscard]] std::string path_of(std::string_view parent, std::size_t index);

}  // namespace grainsweep::campaign
