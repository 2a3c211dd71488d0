// A case answered by a program: its folder, its process, what it left. See campaign/program.hpp for what a program is.
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

/// Called about ten times a second; returns false to give the case up unfinished.
using Pulse = std::function<bool()>;

struct ProgramOptions {
    std::filesystem::path folder;         ///< holds the folders of cases
    std::optional<double> limit_seconds;  ///< of a case
    /// Where given, the case's folder is this one, and stays.
    std::filesystem::path keep = {};
};

class ProgramLines;

class ProgramAnswerer {
public:
    ProgramAnswerer(std::shared_ptr<const campaign::Program> program, ProgramOptions options, ProgramGuard& guard);
    ProgramAnswerer(const ProgramAnswerer&) = delete;
    ProgramAnswerer& operator=(const ProgramAnswerer&) = delete;
    ~ProgramAnswerer();

    /// Nothing where `pulse` gave it up. Throws BrokenWorld where the program cannot be started here, is of another
    /// version than the campaign was read with, or a file cannot be written.
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
    std::int64_t kept_ = -1;  ///< folders of failed cases that are there; -1: not counted yet
};

/// What the version command says, asked in an empty folder. Throws std::runtime_error with a sentence.
[[nodiscard]] std::string ask_version(const campaign::Program& program, ProgramGuard& guard);
/// Why the program's command cannot be started here; empty: it can.
[[nodiscard]] std::string why_not_here(const campaign::Program& program);

/// Puts a program and its files where workers find them by the name of its scene; and finds it there. Files larger
/// than a megabyte stay on disk. Both throw BrokenWorld.
void stage_program(const campaign::Program& program, const std::filesystem::path& cases);
[[nodiscard]] std::shared_ptr<const campaign::Program> staged_program(std::string_view scene,
                                                                      const std::filesystem::path& cases);
/// Removes it again, and the folder where nothing else is in it.
void unstage_program(std::string_view scene, const std::filesystem::path& cases);

/// The program's argv and environment for a case; for a program that stays alive `question` is nullptr.
[[nodiscard]] std::vector<std::string> program_argv(const campaign::Program& program, const campaign::Case* question);
[[nodiscard]] std::vector<std::string> program_environment(const campaign::Program& program,
                                                           const campaign::Case* question);
/// Files and, with a question, templates and inputs.json.
void fill_folder(const ProgramFolder& folder, const campaign::Program& program, const campaign::Case* question);

}  // namespace grainsweep::workers
