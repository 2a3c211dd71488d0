// Strict reader of JSON. It refuses, with their place, repeated keys, NaN, Infinity, numbers beyond double, comments,
// bytes that are not UTF-8, and too deep nesting.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace grainsweep::campaign {

using Json = nlohmann::json;

/// Returns the document. Throws InputError at "line L, column C" if the text is no JSON, or at the JSON path of a
/// repeated key, of a text with NUL, or of nesting deeper than 32. A UTF-8 byte-order mark is skipped.
[[nodiscard]] Json parse_json(std::string_view text);

/// Returns a value as text for messages: compact JSON in printable ASCII, shortened to about 60 characters.
[[nodiscard]] std::string shown(const Json& value);

/// Returns the path of a key: "$.factors" and "speed" -> "$.factors.speed"; a key that is no plain word becomes
/// ["key"].
[[nodiscard]] std::string path_of(std::string_view parent, std::string_view key);
/// Returns the path of an element: "$.factors" and 1 -> "$.factors[1]".
[[nodiscard]] std::string path_of(std::string_view parent, std::size_t index);

}  // namespace grainsweep::campaign
