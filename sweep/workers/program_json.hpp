// JSON that a program wrote. Numbers outside double precision, repeated keys and too deep nesting are refused, with
// their place.
#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <string_view>

namespace grainsweep::workers {

/// Error: the text is not JSON.
class NoJson : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Returns the parsed text. `name` stands before the place in messages. Throws NoJson, or std::invalid_argument for
/// JSON that is refused.
[[nodiscard]] nlohmann::json program_json(std::string_view text, const std::string& name);

/// Returns a value as a short printable text for messages.
[[nodiscard]] std::string shown_json(const nlohmann::json& value);

}  // namespace grainsweep::workers
