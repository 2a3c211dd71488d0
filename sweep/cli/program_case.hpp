// One case of a program in this process: solve and replay.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/pictures.hpp"

#include <filesystem>
#include <memory>

namespace grainsweep::cli {

/// `keep`: a new folder that the case is answered in and that stays; empty: one of its own, removed in the end.
/// Refuses pictures, which a program does not give, and a folder that is there.
[[nodiscard]] campaign::CaseResult answer_by_program(std::shared_ptr<const campaign::Program> program,
                                                     const campaign::Case& question, std::int64_t attempt,
                                                     std::optional<double> limit_seconds,
                                                     const std::filesystem::path& keep, const PictureRequest& pictures);

}  // namespace grainsweep::cli
