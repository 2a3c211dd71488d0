// Placeholders for values: {name} in a command and an environment, {{ name }} in a template.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Function that returns the value of a name. Throws if there is none.
using ValueOf = std::function<std::string(std::string_view name)>;

/// Returns whether a word has only letters, digits and _, no digit first.
[[nodiscard]] bool is_plain_name(std::string_view word);
/// Replaces {name} by its value and {{name}} by {name}; other braces do not change.
[[nodiscard]] std::string filled_command(std::string_view text, const ValueOf& value_of);
/// Replaces {{ name }}, with any blanks, by its value. Throws std::invalid_argument with a sentence and the line if
/// double braces contain no name; braces that are not closed in their line do not change.
[[nodiscard]] std::string filled_template(std::string_view text, const ValueOf& value_of);

}  // namespace grainsweep::campaign
