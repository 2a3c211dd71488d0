// Completion of the command line in bash and zsh, generated from the table of commands, the scenes and the designs.
#pragma once

#include "sweep/cli/command.hpp"

#include <span>
#include <string>

namespace grainsweep::cli {

/// A script to be sourced, or to be installed as share/bash-completion/completions/grainsweep.
[[nodiscard]] std::string bash_completion(std::span<const CommandInfo> commands);
/// A function to be installed as _grainsweep in a folder of fpath; it can be sourced too.
[[nodiscard]] std::string zsh_completion(std::span<const CommandInfo> commands);

}  // namespace grainsweep::cli
