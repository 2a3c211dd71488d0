// Campaigns whose cases a program answers: existence and version of the program, folders of the cases; and one of its
// cases in this process, for solve and replay.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/pictures.hpp"

#include <filesystem>
#include <memory>
#include <string_view>

namespace grainsweep::cli {

/// Compiles the conditions of the factors. Checks the program of a campaign: refuses a missing one (unless workers
/// start elsewhere) and runs its version command, because the version is part of every case's identity. Messages name
/// `config`.
[[nodiscard]] campaign::Campaign with_program(campaign::Campaign campaign, const std::filesystem::path& config);
/// Reads and checks a campaign file in this way; `experiment` chooses one of a calibration with several.
[[nodiscard]] campaign::Campaign read_with_program(const std::filesystem::path& config,
                                                   std::string_view experiment = {});
/// Parses and checks a text instead of the file.
[[nodiscard]] campaign::Campaign parse_with_program(std::string_view text, const std::filesystem::path& config);

/// Stored program for workers, during the lifetime of this object; then files that are not kept are removed.
class StagedProgram {
public:
    StagedProgram(std::shared_ptr<const campaign::Program> program, std::filesystem::path cases);
    StagedProgram(const StagedProgram&) = delete;
    StagedProgram& operator=(const StagedProgram&) = delete;
    ~StagedProgram();

private:
    std::shared_ptr<const campaign::Program> program_;
    std::filesystem::path cases_;
};

/// Returns the answer of a case. `keep`: a new folder for the case, which is kept; empty: a temporary one. Refuses
/// pictures, which a program does not have, and an existing folder.
[[nodiscard]] campaign::CaseResult answer_by_program(std::shared_ptr<const campaign::Program> program,
                                                     const campaign::Case& question, std::int64_t attempt,
                                                     std::optional<double> limit_seconds,
                                                     const std::filesystem::path& keep, const PictureRequest& pictures);

}  // namespace grainsweep::cli
