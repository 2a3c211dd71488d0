// A campaign whose cases a program answers, as far as commands have to see to it: is the program here, which version is
// it, where do the cases' folders lie.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/program.hpp"

#include <filesystem>
#include <memory>
#include <string_view>

namespace grainsweep::cli {

/// Compiles the conditions of the factors. Checks the program of a campaign: refuses a missing one (unless workers
/// start elsewhere) and runs its version command, because the version is part of every case's identity. Messages name
/// `config`.
[[nodiscard]] campaign::Campaign with_program(campaign::Campaign campaign, const std::filesystem::path& config);
/// Reads a campaign file so; `experiment` chooses one of a calibration over several.
[[nodiscard]] campaign::Campaign read_with_program(const std::filesystem::path& config,
                                                   std::string_view experiment = {});
/// The same of a text in the place of the file.
[[nodiscard]] campaign::Campaign parse_with_program(std::string_view text, const std::filesystem::path& config);

/// Puts the program where workers find it, for as long as this lives; then removes what is not kept.
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

}  // namespace grainsweep::cli
