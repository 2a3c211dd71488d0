// Commands that a text suggests, so that the reader can copy them into the same terminal.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::report {

/// Returns the word in single quotes if a shell would read it as anything but one plain word.
[[nodiscard]] std::string shell_word(std::string_view word);

/// Returns the command line of this program with these arguments, named as the user started it: "build/grainsweep ...".
[[nodiscard]] std::string next_command(std::string_view arguments);

}  // namespace grainsweep::report
