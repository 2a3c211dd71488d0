// Command: a name, a sentence, its arguments and its action. main has the table.
#pragma once

#include "sweep/cli/parser.hpp"
#include "sweep/report/table.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::cli {

/// Action of a command after its arguments are parsed; returns the exit code.
using Action = std::function<int()>;

struct Command {
    std::string name;
    std::string summary;
    /// Declares the command's arguments and returns its action. `format`: value of --format, which every command has;
    /// it is read when the action runs.
    std::function<Action(Parser& parser, const report::Format& format)> declare;
    bool hidden = false;
    bool verbatim = false;     ///< its text is also for programs: lines are never wrapped
    std::string example = {};  ///< example at the end of --help
    bool workbook = false;     ///< --format may be xlsx
};

/// Makes a command with a Request: `arguments(parser, request)` declares its arguments, `act(request, format)` runs it
/// and returns the exit code.
template <class Request>
Command command(std::string name, std::string summary, auto arguments, auto act) {
    return {std::move(name), std::move(summary),
            [arguments, act](Parser& parser, const report::Format& format) -> Action {
                const auto request = std::make_shared<Request>();
                arguments(parser, *request);
                return [act, request, &format] { return act(*request, format); };
            }};
}
/// Makes a command that --help does not list.
[[nodiscard]] inline Command hidden(Command command) {
    command.hidden = true;
    return command;
}
[[nodiscard]] inline Command verbatim(Command command) {
    command.verbatim = true;
    return command;
}
[[nodiscard]] inline Command with_workbook(Command command) {
    command.workbook = true;
    return command;
}

// One line per group of commands; each group has a file of its own.
[[nodiscard]] std::vector<Command> plan_commands();       // plan
[[nodiscard]] std::vector<Command> run_commands();        // run, calibrate, worker, host
[[nodiscard]] std::vector<Command> spool_commands();      // work, collect
[[nodiscard]] std::vector<Command> import_commands();     // import
[[nodiscard]] std::vector<Command> archive_commands();    // status, explain, replay, query, dump
[[nodiscard]] std::vector<Command> verify_commands();     // verify
[[nodiscard]] std::vector<Command> study_commands();      // converge, sensitivity, report
[[nodiscard]] std::vector<Command> figure_commands();     // figure
[[nodiscard]] std::vector<Command> serve_commands();      // serve
[[nodiscard]] std::vector<Command> decide_commands();     // predict, window
[[nodiscard]] std::vector<Command> accuracy_commands();   // accuracy
[[nodiscard]] std::vector<Command> solve_commands();      // solve
[[nodiscard]] std::vector<Command> catalogue_commands();  // scenes, machines, designs, schema
[[nodiscard]] std::vector<Command> draw_commands();       // draw
[[nodiscard]] std::vector<Command> powder_commands();     // powder
[[nodiscard]] std::vector<Command> shape_commands();      // shape
[[nodiscard]] std::vector<Command> manual_commands();     // completion, manual

/// Returns all commands, in the order of --help.
[[nodiscard]] std::vector<Command> all_commands();

/// Argument of a command, for texts generated from the table of commands.
struct ArgumentInfo {
    std::vector<std::string> names;  ///< "-o", "--output"; empty: a positional argument
    std::string place;               ///< "CONFIG", "DB"; empty: an option
    std::string value;               ///< placeholder of its value; empty: a flag
    std::string help;
    bool required = false, repeated = false;
};
struct CommandInfo {
    std::string name, summary;
    std::vector<ArgumentInfo> arguments;  ///< including --help
};
[[nodiscard]] std::vector<CommandInfo> describe(const std::vector<Command>& commands);

/// Returns the action of the command in the arguments. --help and --version print their text and return an action that
/// does nothing. Throws InputError with one sentence, and the nearest word, for unknown arguments.
[[nodiscard]] Action parse_command_line(const std::vector<Command>& commands, int argc, const char* const* argv);

}  // namespace grainsweep::cli
