// Options of commands that compute in this process: --path, a narrower instruction set than the widest of this
// processor; --threads, the number of threads for a single case.
#pragma once

#include "sweep/cli/parser.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Adds --path to a command. The word is empty if the option is not given, which means `otherwise`.
void declare_path(Parser& parser, std::string& word, std::string_view otherwise = "the widest of the processor");
/// Makes this process compute with this path; an empty word has no effect. Throws InputError for an unknown word and
/// for a path that this processor lacks.
void use_path(const std::string& word);
/// Makes this process compute with the path stored in a database, if this processor has it, because only the same path
/// gives the same bits.
void use_path_of_old(std::string_view path);

/// Adds --threads to a command; 0, the default, means one thread per core of the job.
void declare_threads(Parser& parser, std::int64_t& count);
/// Sets the largest number of threads of a case in this process.
void use_threads(std::int64_t count);

}  // namespace grainsweep::cli
