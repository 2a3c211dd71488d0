// What a program measured: from the files it left or the line it replied, to observations, checked.
#pragma once

#include "sweep/campaign/program.hpp"
#include "sweep/workers/program_folder.hpp"

#include <string>
#include <string_view>

namespace grainsweep::workers {

/// What a program said of its case.
struct ProgramReply {
    enum class Kind { measured, unstable, rejected };
    Kind kind = Kind::measured;
    std::string message;  ///< why, in one sentence that names file and place; empty where it measured
    Observations observations;
};

/// From the case's folder, once the program has ended well.
[[nodiscard]] ProgramReply results_in(const ProgramFolder& folder, const campaign::Program& program);
/// From a line of the protocol "lines". Throws std::invalid_argument with a sentence where it is no such line.
[[nodiscard]] ProgramReply results_in(std::string_view line, std::string_view case_id,
                                      const campaign::Program& program);

}  // namespace grainsweep::workers
