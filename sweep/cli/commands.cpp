// The table of commands.
#include "sweep/cli/command.hpp"

namespace grainsweep::cli {

std::vector<Command> all_commands() {
    std::vector<Command> commands;
    for (const auto& group : {
             plan_commands(),
             run_commands(),
             spool_commands(),
             archive_commands(),
             verify_commands(),
             study_commands(),
             figure_commands(),
             serve_commands(),
             decide_commands(),
             accuracy_commands(),
             solve_commands(),
             draw_commands(),
             catalogue_commands(),
             manual_commands(),
         }) {
        commands.insert(commands.end(), group.begin(), group.end());
    }
    return commands;
}

}  // namespace grainsweep::cli
