// A program that stays alive and answers line by line.
#pragma once

#include "sweep/campaign/program.hpp"
#include "sweep/files/descriptor.hpp"
#include "sweep/workers/program_folder.hpp"
#include "sweep/workers/program_process.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class ProgramLines {
public:
    enum class Go { on, stop, give_up };
    enum class Heard { reply, end, ended_before, too_long, unasked, stopped, given_up };

    /// Starts the program in a folder of its own within `cases`. Throws BrokenWorld if it cannot be started.
    ProgramLines(const campaign::Program& program, const std::filesystem::path& cases, ProgramGuard& guard);
    ProgramLines(const ProgramLines&) = delete;
    ProgramLines& operator=(const ProgramLines&) = delete;

    /// Writes the question and waits for the line of the answer; line() returns it without its line end. `look` is
    /// called about ten times a second. `ended_before`: the program had ended before the question.
    [[nodiscard]] Heard ask(const std::string& question, const std::function<Go()>& look);
    [[nodiscard]] const std::string& line() const { return line_; }

    /// Ends the program. Then result() is valid.
    void end();
    /// Returns whether the program ends by itself, at once, with exit code 0.
    [[nodiscard]] bool ended_well();
    [[nodiscard]] const ProgramEnd& result() const { return process_->result(); }
    [[nodiscard]] double cpu_seconds() const { return process_->cpu_seconds(); }
    /// Returns the largest resident memory so far in bytes; NaN if the system does not report it.
    [[nodiscard]] double peak_memory() const;
    [[nodiscard]] const ProgramFolder& folder() const { return folder_; }

private:
    /// Takes a line from the received bytes. Returns false if no line is complete yet.
    [[nodiscard]] bool take_line();
    [[nodiscard]] std::optional<Heard> exchange(std::string_view& rest, int milliseconds);
    void shorten_log() const;

    ProgramFolder folder_;
    files::Descriptor in_, out_, status_, log_;
    std::unique_ptr<ProgramProcess> process_;  // ended before its pipes are closed
    std::string received_, line_;
    std::size_t searched_ = 0;  ///< of received_, without a line end
};

}  // namespace grainsweep::workers
