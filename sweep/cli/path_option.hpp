// --path: a narrower instruction set than the widest this processor has, for tests and benchmarks.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace grainsweep::cli {

/// Adds --path to a command; empty where it is not given.
void declare_path(CLI::App& parser, std::string& word);
/// Makes this process compute with that path; an empty word changes nothing. Throws WrongQuestion on an unknown word
/// and on a path this processor lacks.
void use_path(const std::string& word);

}  // namespace grainsweep::cli
