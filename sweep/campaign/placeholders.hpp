// Names in texts that stand for values: {name} in a command and an environment, {{ name }} in a template.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// The value of a name. Throws where there is none.
using ValueOf = std::function<std::string(std::string_view name)>;

/// Letters, digits and _, no digit first.
[[nodiscard]] bool is_plain_name(std::string_view word);
/// {name} by its value, {{name}} by {name}; every other brace stays.
[[nodiscard]] std::string filled_command(std::string_view text, const ValueOf& value_of);
/// {{ name }}, blanks as one likes, by its value. Throws std::invalid_argument with a sentence and the line where a
/// double brace holds something else than a name; one that is not closed in its line stays.
[[nodiscard]] std::string filled_template(std::string_view text, const ValueOf& value_of);

}  // namespace grainsweep::campaign
