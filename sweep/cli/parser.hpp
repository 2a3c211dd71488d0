// The arguments of one command: what a command declares, and nothing of the library behind it (CLI11), whose headers
// take longer to compile than a command does.
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

/// A rule for an argument: a whole number from `least` to `most`.
struct WholeNumber {
    std::int64_t least = 0;
    std::int64_t most = std::numeric_limits<std::int64_t>::max();
};
[[nodiscard]] constexpr WholeNumber whole_number(std::int64_t least,
                                                 std::int64_t most = std::numeric_limits<std::int64_t>::max()) {
    return {least, most};
}

/// One argument; every call returns it again.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option* required();
    Option* check(WholeNumber rule);
    /// Of a list: false takes one value each time the option is given.
    Option* allow_extra_args(bool allowed);
    /// Digits may be grouped by underscores, as csv prints large numbers.
    Option* grouped_digits();
    /// --help shows the value the variable has now.
    Option* capture_default_str();

private:
    CLI::Option* option_;
};

/// Declares arguments: "DB" is a place, "[NAME]" one that may be empty, "-o,--output FILE" an option with two
/// names and the word for its value in --help. `into` is written when the command line is read and must still
/// exist then.
class Parser {
public:
    explicit Parser(CLI::App& app) : app_(&app) {}
    /// Of a text, a path, a list of texts, a number, or a whole number that may be absent.
    template <class T>
    Option* add_option(const std::string& names, T& into, const std::string& help);
    Option* add_flag(const std::string& names, bool& into, const std::string& help);

private:
    CLI::App* app_;
    std::deque<Option> options_;
};

}  // namespace grainsweep::cli
