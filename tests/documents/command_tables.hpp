// Generated tables from the help and the manual page of the program.
#pragma once

#include <string>

namespace grainsweep::tests {

[[nodiscard]] std::string commands_table();
/// The arguments and options of one command, without those of every command, and its example.
[[nodiscard]] std::string command_table(const std::string& command);
/// The entries of one section of the manual page.
[[nodiscard]] std::string manual_table(const std::string& section);

}  // namespace grainsweep::tests
