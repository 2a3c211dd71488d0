// One case of a program in this process, for solve and replay.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/pictures.hpp"

#include <filesystem>
#include <memory>

namespace grainsweep::cli {

/// Returns the answer of a case. `keep`: a new folder for the case, which is kept; empty: a temporary one. Refuses
/// pictures, which a program does not have, and an existing folder.
[[nodiscard]] campaign::CaseResult answer_by_program(std::shared_ptr<const campaign::Program> program,
                                                     const campaign::Case& question, std::int64_t attempt,
                                                     std::optional<double> limit_seconds,
                                                     const std::filesystem::path& keep, const PictureRequest& pictures);

}  // namespace grainsweep::cli
