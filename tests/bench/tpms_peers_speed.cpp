// Whole discharges side by side with LIGGGHTS: the same packing, wall, law and time step, user seconds, one core.
//
//   bench_tpms_peers [--edge N] [--case NAME]
//
// Schwarz-P without cohesion and jammed at k_c = 35 kJ/m3, Gyroid at 35 kJ/m3; edge 30 diameters, shell 2, gravity
// 9.81 x 100/30 as the reference's scaling, to 6.1 t*. LIGGGHTS writes nothing on the way and is set to leave pairs
// of wall spheres out. Ours: `grainsweep solve` as a user runs it, packing read from a file, ended when the powder has
// settled; the same with powder at rest left alone (rest_speed 0.001, which is not the default), and with the time step
// of "fast"; the engine alone over all steps, with every wall sphere kept; and that one divided by the particle steps.
// One JSON line per case.
#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <string>

#include "solver/dem/engine.hpp"
#include "tests/support/peer_programs.hpp"
#include "tests/support/process.hpp"
#include "tests/support/tpms_cells.hpp"
#include "tests/support/tpms_filling.hpp"

using namespace grainsweep;

namespace {

constexpr double diameter = tests::cell_diameter, time_step = 1e-6, shell_thickness = 2, end_time = 6.1;

double user_seconds() {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

void compare(const std::string& name, geometry::TpmsCell cell, const char* word, double cohesion, double edge,
             const particles::Packing& packing) {
    const machine::LevelSetRegion shell{cell, edge, shell_thickness, +1};
    // every wall sphere is there
    const dem::Setup setup = tests::cell_of(particles::fill_tpms(packing, shell, 0), edge, cohesion, 0);
    const double gravity = 9.81 * 100 / edge;
    const auto steps = std::llround(std::ceil(end_time * std::sqrt(2 * edge * diameter / gravity) / time_step));

    const tests::Folder folder;
    std::string rows = "x,y,z\n";
    for (const auto& x : packing.positions) rows += fmt::format("{},{},{}\n", x[0], x[1], x[2]);
    folder.write("packing.csv", rows);
    nlohmann::json config{{"campaign", "side_by_side"},
                          {"scene", "tpms_discharge"},
                          {"factors", {{{"name", "cohesion"}, {"levels", {cohesion}}}}},
                          {"fixed",
                           {{"cell", word},
                            {"edge", edge},
                            {"shell", shell_thickness},
                            {"gravity", gravity},
                            {"packing", "packing.csv"},
                            {"end_time", end_time}}},
                          {"design", {{"kind", "lattice"}}}};
    const auto solve = [&] {
        folder.write("cell.json", config.dump());
        const auto ran = tests::run_timed(tests::program_command({"solve", "cell.json"}), folder.path());
        if (ran.code != 0) std::fprintf(stderr, "%s\n", ran.out.c_str());
        return ran.user_seconds;
    };
    const double solved = solve();
    config["fixed"]["rest_speed"] = 0.001;
    const double resting = solve();
    config["fixed"].erase("rest_speed");
    config["accuracy"] = "fast";
    const double fast = solve();

    const auto engine = dem::make_engine(setup, {.precision = dem::Method::Precision::mixed});
    const double start = user_seconds();
    engine->run(steps);
    const double plain = user_seconds() - start;

    tests::Ran them;
    if (tests::installed("liggghts")) {
        tests::write_bed(setup, folder.path());
        const tests::Peer peer{tests::Peer::Program::liggghts, 0.2 * diameter, steps, 1, false};
        folder.write("in.cell", tests::deck_of(setup, peer).value());
        them = tests::run_timed({"liggghts", "-in", "in.cell", "-log", "none"}, folder.path());
        if (them.code != 0)
            std::fprintf(stderr, "liggghts ended with %d:\n%s\n", them.code,
                         them.out.substr(them.out.size() - std::min<std::size_t>(400, them.out.size())).c_str());
    }
    fmt::print(
        "{{\"bench\": \"tpms_peers\", \"case\": \"{}\", \"mobile_and_wall\": {}, \"steps\": {}, \"solve_seconds\": "
        "{:.2f}, \"resting_seconds\": {:.2f}, \"fast_seconds\": {:.2f}, \"no_skip_seconds\": {:.2f}, \"no_skip_ns\": "
        "{:.1f}, \"liggghts_seconds\": {:.1f}, "
        "\"times_liggghts\": {:.1f}, \"times_resting\": {:.1f}, \"times_fast\": {:.1f}, \"times_without_skips\": "
        "{:.1f}}}\n",
        name, setup.spheres.size(), steps, solved, resting, fast, plain, 1e9 * plain / engine->work().particle_steps,
        them.user_seconds, them.user_seconds / solved, them.user_seconds / resting, them.user_seconds / fast,
        them.user_seconds / plain);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    double edge = 30;
    std::string wanted;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::string(argv[i]) == "--edge") edge = std::stod(argv[i + 1]);
        if (std::string(argv[i]) == "--case") wanted = argv[i + 1];
    }
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const auto run = [&](const std::string& name, geometry::TpmsCell cell, const char* word, double cohesion) {
        if (wanted.empty() || wanted == name) compare(name, cell, word, cohesion, edge, packing);
    };
    run("schwarz_p_0", geometry::TpmsCell::schwarz_p, "schwarz_p", 0);
    run("schwarz_p_35", geometry::TpmsCell::schwarz_p, "schwarz_p", 35e3);
    run("gyroid_35", geometry::TpmsCell::gyroid, "gyroid", 35e3);
    return 0;
}
