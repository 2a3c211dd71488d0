// --threads: how many threads compute the one case of a command.
#pragma once

#include "sweep/cli/parser.hpp"

#include <cstdint>

namespace grainsweep::cli {

/// Adds --threads to a command; 0, also where it is not given: one for each core of the job.
void declare_threads(Parser& parser, std::int64_t& count);
/// Allows the cases of this process so many threads.
void use_threads(std::int64_t count);

}  // namespace grainsweep::cli
