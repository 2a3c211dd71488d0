// Converts the files or the line that a program wrote to checked observations.
#pragma once

#include "sweep/campaign/program.hpp"
#include "sweep/workers/program_folder.hpp"

#include <string>
#include <string_view>

namespace grainsweep::workers {

/// Results of a program for its case.
struct ProgramReply {
    enum class Kind { measured, unstable, rejected };
    Kind kind = Kind::measured;
    std::string message;  ///< why there are no observations, in one sentence with file and place; empty: there are
    Observations observations;
    bool names_case = false;  ///< a line with the key "case"
};

/// Returns the results in the case's folder, once the program has ended successfully.
[[nodiscard]] ProgramReply results_in(const ProgramFolder& folder, const campaign::Program& program);
/// Returns the results in a line of the protocol "lines". Throws std::invalid_argument with a sentence for an invalid
/// line.
[[nodiscard]] ProgramReply results_in(std::string_view line, std::string_view case_id,
                                      const campaign::Program& program);

}  // namespace grainsweep::workers
