// The table of commands.
#include "sweep/cli/command.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace grainsweep::cli {

namespace {

/// A line of shell for each command that --help lists.
constexpr auto command_examples = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"plan", "plan configs/quickstart.json"},
    {"run", "run configs/quickstart.json --db quick.db"},
    {"calibrate", "calibrate configs/calibrate_drum.json"},
    {"work", "work configs/quickstart.json --spool shared"},
    {"collect", "collect quick.db shared"},
    {"import", "import old_runs.csv bed.json bed.db"},
    {"status", "status quick.db"},
    {"explain", "explain quick.db 3fa2"},
    {"replay", "replay quick.db 3fa2 --watch case.html"},
    {"query", R"(query quick.db "SELECT outcome, count(*) FROM sim_case GROUP BY outcome")"},
    {"dump", "dump quick.db > quick.txt"},
    {"verify", "verify quick.db"},
    {"converge", "converge quick.db --check"},
    {"sensitivity", "sensitivity quick.db"},
    {"report", "report quick.db -o quick.html"},
    {"figure", "figure quick.db effects -o effects.pdf"},
    {"serve", "serve quick.db --open"},
    {"predict", R"(predict quick.db --at "gap=0.004")"},
    {"window", R"(window quick.db --where "mfr > 0.3")"},
    {"solve", "solve configs/quickstart.json --watch case.html"},
    {"accuracy", "accuracy configs/quickstart.json"},
    {"draw", "draw v_blender -o v_blender.html"},
    {"powder", "powder import export.csv -o sizes.csv"},
    {"shape", "shape stone.stl --spheres 12 -o stone.csv"},
    {"scenes", "scenes powder_spreading"},
    {"machines", "machines v_blender"},
    {"designs", "designs halton"},
    {"schema", "schema > campaign.schema.json"},
    {"completion", "completion bash"},
    {"manual", "manual | man -l -"},
});

}  // namespace

std::vector<Command> all_commands() {
    std::vector<Command> commands;
    for (const auto& group : {
             plan_commands(),
             run_commands(),
             spool_commands(),
             import_commands(),
             archive_commands(),
             verify_commands(),
             study_commands(),
             figure_commands(),
             serve_commands(),
             decide_commands(),
             accuracy_commands(),
             solve_commands(),
             draw_commands(),
             powder_commands(),
             shape_commands(),
             catalogue_commands(),
             manual_commands(),
         }) {
        commands.insert(commands.end(), group.begin(), group.end());
    }
    for (auto& command : commands) {
        const auto found = std::ranges::find(command_examples, std::string_view(command.name),
                                             &std::pair<std::string_view, std::string_view>::first);
        if (found != command_examples.end()) command.example = found->second;
    }
    return commands;
}

}  // namespace grainsweep::cli
