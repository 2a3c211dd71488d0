// --path: a narrower instruction set than the widest this processor has.
#pragma once

#include "sweep/cli/parser.hpp"

#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Adds --path to a command; empty where it is not given, which means `otherwise`.
void declare_path(Parser& parser, std::string& word, std::string_view otherwise = "the widest of the processor");
/// Makes this process compute with that path; an empty word changes nothing. Throws WrongQuestion on an unknown word
/// and on a path this processor lacks.
void use_path(const std::string& word);
/// Makes this process compute with the path that an archive names (instruction_path() of then), where this processor
/// has it: only the same path repeats the same bits.
void use_path_of_old(std::string_view path);

}  // namespace grainsweep::cli
