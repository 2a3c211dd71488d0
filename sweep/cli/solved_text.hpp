// Result of `solve` as text.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/case.hpp"

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Returns the scalars that the scene declares and a completed case has no value of.
[[nodiscard]] std::vector<ObservableSpec> absent(const campaign::Case& question, const campaign::CaseResult& result);

/// Writes the named inputs and the main observables, in at most 20 lines.
void write_main_case(std::ostream& out, const campaign::Case& question, std::span<const std::string> inputs,
                     const campaign::CaseResult& result);
/// Writes every input that differs from its default and every observable, with its meaning.
void write_whole_case(std::ostream& out, const campaign::Case& question, const campaign::CaseResult& result);

}  // namespace grainsweep::cli
