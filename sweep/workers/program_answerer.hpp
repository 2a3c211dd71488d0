// Answers a case by running a program (campaign/program.hpp): its folder, its process, its results.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/workers/program_folder.hpp"
#include "sweep/workers/program_guard.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace grainsweep::workers {

/// Function called about ten times a second; returns false to interrupt the case.
using Pulse = std::function<bool()>;

struct ProgramOptions {
    std::filesystem::path folder;         ///< parent of the folders of cases
    std::optional<double> limit_seconds;  ///< time limit of a case
    /// Folder of the case, which is kept; empty: a temporary one.
    std::filesystem::path keep = {};
};

class ProgramLines;

class ProgramAnswerer {
public:
    ProgramAnswerer(std::shared_ptr<const campaign::Program> program, ProgramOptions options, ProgramGuard& guard);
    ProgramAnswerer(const ProgramAnswerer&) = delete;
    ProgramAnswerer& operator=(const ProgramAnswerer&) = delete;
    ~ProgramAnswerer();

    /// Returns the answer; empty if `pulse` interrupted the case. Throws SystemError if the program cannot be started
    /// here, has another version than when the campaign was read, or a file cannot be written.
    [[nodiscard]] std::optional<campaign::CaseResult> answer(const campaign::Case& question, std::int64_t attempt,
                                                             const Pulse& pulse);

private:
    [[nodiscard]] std::optional<campaign::CaseResult> by_files(const campaign::Case& question, std::int64_t attempt,
                                                               const Pulse& pulse);
    [[nodiscard]] std::optional<campaign::CaseResult> by_lines(const campaign::Case& question, std::int64_t attempt,
                                                               const Pulse& pulse);
    void keep_or_remove(ProgramFolder& folder, const campaign::CaseResult& result);
    void check_version();

    std::shared_ptr<const campaign::Program> program_;
    ProgramOptions options_;
    ProgramGuard& guard_;
    std::unique_ptr<ProgramLines> lines_;
    bool version_checked_ = false;
    std::int64_t kept_ = -1;  ///< existing folders of failed cases; -1: not counted yet
};

/// Returns the output of the program's version command, run in an empty folder. Throws std::runtime_error with a
/// sentence.
[[nodiscard]] std::string ask_version(const campaign::Program& program, ProgramGuard& guard);
/// Returns why the program's command cannot be started here; empty: it can.
[[nodiscard]] std::string why_not_here(const campaign::Program& program);

/// Stores a program and its files under the name of its scene; staged_program() returns the stored program. Files
/// larger than a megabyte stay in their place on disk. Both throw SystemError.
void stage_program(const campaign::Program& program, const std::filesystem::path& cases);
[[nodiscard]] std::shared_ptr<const campaign::Program> staged_program(std::string_view scene,
                                                                      const std::filesystem::path& cases);
/// Removes a stored program, and the folder if it is then empty.
void unstage_program(std::string_view scene, const std::filesystem::path& cases);

/// Returns the program's arguments for a case. `question` is nullptr for a program that stays alive.
[[nodiscard]] std::vector<std::string> program_argv(const campaign::Program& program, const campaign::Case* question);
[[nodiscard]] std::vector<std::string> program_environment(const campaign::Program& program,
                                                           const campaign::Case* question);
/// Writes the program's files into the folder and, for a case, its templates and inputs.json.
void fill_folder(const ProgramFolder& folder, const campaign::Program& program, const campaign::Case* question);

}  // namespace grainsweep::workers
