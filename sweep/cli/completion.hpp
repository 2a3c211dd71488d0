// Completion of the command line in bash and zsh, generated from the table of commands, the scenes and the designs.
#pragma once

#include "sweep/cli/command.hpp"

#include <span>
#include <string>

namespace grainsweep::cli {

/// Returns a script to be sourced, or to be installed as share/bash-completion/completions/grainsweep.
[[nodiscard]] std::string bash_completion(std::span<const CommandInfo> commands);
/// Returns a function to be installed as _grainsweep in a folder of fpath, or to be sourced.
[[nodiscard]] std::string zsh_completion(std::span<const CommandInfo> commands);

}  // namespace grainsweep::cli
