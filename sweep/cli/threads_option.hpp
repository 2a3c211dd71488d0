// Option --threads: number of threads for the single case of a command.
#pragma once

#include "sweep/cli/parser.hpp"

#include <cstdint>

namespace grainsweep::cli {

/// Adds --threads to a command; 0, the default, means one thread per core of the job.
void declare_threads(Parser& parser, std::int64_t& count);
/// Sets the largest number of threads of a case in this process.
void use_threads(std::int64_t count);

}  // namespace grainsweep::cli
