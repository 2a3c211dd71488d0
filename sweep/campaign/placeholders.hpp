// Placeholders for values: {name} in a command and an environment, {{ name }} in a template. A number may have a format
// of C: {name:%.3e}.
#pragma once

#include "sweep/campaign/plain_name.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Function that returns the value of a name, in a format ("%.3e"; empty: none). Returns nothing for braces that are no
/// placeholder. Throws if there is no such value.
using ValueOf = std::function<std::optional<std::string>(std::string_view name, std::string_view format)>;

/// Replaces {name} by its value and {{name}} by {name}; other braces do not change.
[[nodiscard]] std::string filled_command(std::string_view text, const ValueOf& value_of);
/// Replaces {{ name }}, with any blanks, by its value. Throws std::invalid_argument with a sentence and the line if
/// double braces contain no name; braces that are not closed in their line do not change.
[[nodiscard]] std::string filled_template(std::string_view text, const ValueOf& value_of);

/// Format of a number as in C: % flags width .precision, and one of e E f F g G d.
class NumberFormat {
public:
    /// Returns nothing for another text.
    [[nodiscard]] static std::optional<NumberFormat> parse(std::string_view text);
    /// Returns whether it is the format of a whole number, %d.
    [[nodiscard]] bool is_whole() const { return whole_; }
    [[nodiscard]] std::string operator()(double number) const;
    [[nodiscard]] std::string operator()(std::uint64_t number) const;

private:
    std::string pattern_;  // of fmt
    bool whole_ = false;
};

}  // namespace grainsweep::campaign
