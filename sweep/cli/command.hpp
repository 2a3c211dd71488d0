// What a command is: a name, a sentence, its arguments and what it does. main has the table.
#pragma once

#include "sweep/report/table.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Runs the command after its arguments were read; returns the exit code.
using Action = std::function<int()>;

struct Command {
    std::string name;
    std::string summary;
    /// Adds the command's arguments to its parser and returns what to do with them. `format` is the value of
    /// --format, which every command has; it is read when the action runs.
    std::function<Action(CLI::App& parser, const report::Format& format)> declare;
    bool hidden = false;
};

/// Checks an argument: a whole number from `least` to `most`; the complaint says so.
[[nodiscard]] CLI::Validator whole_number(std::int64_t least,
                                          std::int64_t most = std::numeric_limits<std::int64_t>::max());

// One line per group of commands; each group has a file of its own.
[[nodiscard]] std::vector<Command> plan_commands();       // plan
[[nodiscard]] std::vector<Command> run_commands();        // run, worker
[[nodiscard]] std::vector<Command> archive_commands();    // status, explain, replay, query, dump
[[nodiscard]] std::vector<Command> study_commands();      // converge, sensitivity, report
[[nodiscard]] std::vector<Command> solve_commands();      // solve
[[nodiscard]] std::vector<Command> catalogue_commands();  // scenes, designs, schema

/// The commands as subcommands of `app`. The chosen one's action is in `chosen` after parsing.
void declare(CLI::App& app, const std::vector<Command>& commands, Action& chosen);
/// The first argument that is no option must name a command: else WrongQuestion with the nearest.
void check_command(const std::vector<Command>& commands, int argc, const char* const* argv);
/// A parse error in one sentence, with the nearest option where an unknown one was given.
[[nodiscard]] std::string sentence_of(const CLI::ParseError& error, const CLI::App& app);

}  // namespace grainsweep::cli
