// JSON that a program wrote. What double precision cannot hold, a key twice and nesting beyond any use are refused
// where they stand.
#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <string_view>

namespace grainsweep::workers {

/// The text is no JSON at all.
class NoJson : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// `name` stands before the place in sentences. Throws NoJson; std::invalid_argument for JSON that is not to be used.
[[nodiscard]] nlohmann::json program_json(std::string_view text, const std::string& name);

/// A value as a message shows it, printable and short.
[[nodiscard]] std::string shown_json(const nlohmann::json& value);

}  // namespace grainsweep::workers
