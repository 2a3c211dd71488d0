// Arguments of a command, without the headers of the library (CLI11), which take longer to compile than a command.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace grainsweep::cli {

/// Rule for an argument: a whole number from `least` to `most`.
struct WholeNumber {
    std::int64_t least = 0;
    std::int64_t most = std::numeric_limits<std::int64_t>::max();
};
[[nodiscard]] constexpr WholeNumber whole_number(std::int64_t least,
                                                 std::int64_t most = std::numeric_limits<std::int64_t>::max()) {
    return {least, most};
}

/// Argument; every call returns it.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option* required();
    Option* check(WholeNumber rule);
    /// For a list: false takes one value for each occurrence of the option.
    Option* allow_extra_args(bool allowed);
    /// Allows underscores between digits, as in large numbers of csv.
    Option* grouped_digits();
    /// Shows the present value of the variable in --help.
    Option* capture_default_str();

private:
    CLI::Option* option_;
};

/// Parser that declares arguments: "DB" is positional, "[NAME]" positional and optional, "-o,--output FILE" an option
/// with two names and the placeholder of its value in --help. `into` is written when the command line is parsed and
/// must still exist then.
class Parser {
public:
    explicit Parser(CLI::App& app) : app_(&app) {}
    /// Declares an argument: a text, a path, a list of texts, a number, or an optional whole number.
    template <class T>
    Option* add_option(const std::string& names, T& into, const std::string& help);
    Option* add_flag(const std::string& names, bool& into, const std::string& help);

private:
    CLI::App* app_;
    std::deque<Option> options_;
};

}  // namespace grainsweep::cli
