// Side by side with LIGGGHTS and LAMMPS: the same states, the same time step, user seconds, one core, in turn.
//
//   bench_peers [--scene NAME] [--skins N]
//
// Beds and chutes: nanoseconds per particle and step from the difference of a long and a short run, so that reading
// and the first lists do not count; LIGGGHTS and LAMMPS with the fastest of several list skins (in diameters), ours
// with its own choice, measured before and after and the slower one taken. The figures of the flow at the end of the
// run (kinetic energy, mean velocity, coordination number) stand beside the times. Spreading: the 16 cases of the
// reference table end to end, `grainsweep solve` against LIGGGHTS without any output. Campaign: the first 24 cases of
// configs/wu2020_lds.json, wall time of `grainsweep run` on all cores against LIGGGHTS (the thesis's step of 1e-5 s, no
// output) under GNU Parallel on as many, and what that makes for the whole campaign. One JSON line per comparison.
#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/granular_beds.hpp"
#include "tests/support/peer_programs.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"
#include "tests/support/reference.hpp"

using namespace grainsweep;
using dem::Method;

namespace {

struct Options {
    std::string scene;
    std::vector<double> skins = {0.1, 0.2, 0.3};
};

double user_seconds() {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

struct Measured {
    double nanoseconds = 0;  ///< per particle and step
    tests::Figures figures;
};

Measured ours(const dem::Setup& setup, Method::Path path, std::int64_t steps) {
    const auto engine = dem::fast::make_mixed_engine(setup, path);
    engine->run(105);
    const double start = user_seconds();
    engine->run(steps - 5);
    const double spent = user_seconds() - start;
    dem::State state;
    engine->state(state);
    return {1e9 * spent / static_cast<double>(steps - 5) / static_cast<double>(engine->size()),
            tests::figures_of(state, setup)};
}

/// The fastest over the skins.
std::optional<Measured> theirs(const Options& o, tests::Peer::Program program, const dem::Setup& setup,
                               std::int64_t steps, bool forgetful = false) {
    const std::string name = program == tests::Peer::Program::liggghts ? "liggghts" : "lmp";
    if (!tests::installed(name)) return std::nullopt;
    std::optional<Measured> best;
    const tests::Folder folder;
    tests::write_bed(setup, folder.path());
    for (const double skin : o.skins) {
        double seconds[2] = {0, 0};
        std::string out;
        for (int k = 0; k < 2; ++k) {
            const tests::Peer peer{program, skin * 2 * setup.spheres[0].radius, k == 0 ? 5 : steps, 100, forgetful};
            const auto deck = tests::deck_of(setup, peer);
            if (!deck) return std::nullopt;
            folder.write("in.bed", *deck);
            const auto ran = tests::run_timed({name, "-in", "in.bed", "-log", "none"}, folder.path());
            if (ran.code != 0) {
                std::fprintf(stderr, "%s ended with %d:\n%s\n", name.c_str(), ran.code,
                             ran.out.substr(ran.out.size() - std::min<std::size_t>(400, ran.out.size())).c_str());
                return std::nullopt;
            }
            seconds[k] = ran.user_seconds;
            out = ran.out;
        }
        const double ns = 1e9 * (seconds[1] - seconds[0]) / static_cast<double>(steps - 5) /
                          static_cast<double>(setup.spheres.size());
        if (!best || ns < best->nanoseconds) best = Measured{ns, tests::printed_figures(out)};
    }
    return best;
}

std::string as_json(const std::optional<Measured>& m) {
    if (!m) return "null";
    return fmt::format(
        "{{\"ns\": {:.2f}, \"kinetic_energy\": {:.5g}, \"velocity_x\": {:.5g}, \"coordination\": {:.4f}}}",
        m->nanoseconds, m->figures.kinetic_energy, m->figures.velocity_x, m->figures.coordination);
}

void compare(const Options& o, const std::string& scene, const dem::Setup& setup, std::int64_t steps) {
    const auto liggghts = theirs(o, tests::Peer::Program::liggghts, setup, steps);
    const auto lammps = theirs(o, tests::Peer::Program::lammps, setup, steps);
    for (const auto& [name, path] : {std::pair{"avx512", Method::Path::avx512}, std::pair{"avx2", Method::Path::avx2},
                                     std::pair{"baseline", Method::Path::baseline}}) {
        if (!dem::fast::supports(path)) continue;
        const auto before = ours(setup, path, steps), after = ours(setup, path, steps);
        const auto& us = before.nanoseconds > after.nanoseconds ? before : after;
        const auto ratio = [&](const std::optional<Measured>& m) {
            return m ? fmt::format("{:.2f}", m->nanoseconds / us.nanoseconds) : std::string("null");
        };
        fmt::print(
            "{{\"bench\": \"peers\", \"scene\": \"{}\", \"particles\": {}, \"steps\": {}, \"path\": \"{}\", "
            "\"grainsweep\": {}, \"liggghts\": {}, \"lammps\": {}, \"times_liggghts\": {}, \"times_lammps\": "
            "{}}}\n",
            scene, setup.spheres.size(), steps, name, as_json(us), as_json(liggghts), as_json(lammps), ratio(liggghts),
            ratio(lammps));
        std::fflush(stdout);
    }
}

/// Long flows from the same starts: where single particles have long parted, the figures must agree. LIGGGHTS with
/// lists of its own pace and with lists anew every step, which changes its law (Peer::forgetful).
void statistics() {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const dem::Setup setup = tests::small_chute(seed);
        const auto steps = std::llround(tests::small_chute_time / setup.time_step) - 100;
        const auto us = ours(setup, Method::Path::best, steps);
        Options once;
        once.skins = {0.3};
        const auto lasting = theirs(once, tests::Peer::Program::liggghts, setup, steps);
        once.skins = {0.1};
        const auto forgetful = theirs(once, tests::Peer::Program::liggghts, setup, steps, true);
        fmt::print(
            "{{\"bench\": \"peers\", \"scene\": \"chute_statistics\", \"seed\": {}, \"grainsweep\": {}, "
            "\"liggghts\": {}, \"liggghts_forgetful\": {}}}\n",
            seed, as_json(us), as_json(lasting), as_json(forgetful));
        std::fflush(stdout);
    }
}

/// The 16 spreading cases, end to end.
void spreading() {
    const auto table = tests::read_table(tests::reference("spreading/mfr_table.csv"));
    const bool peer = tests::installed("liggghts");
    double ours_total = 0, theirs_total = 0;
    const tests::Folder folder;
    folder.write("case.json",
                 R"({"campaign": "side_by_side", "scene": "powder_spreading", "factors": [)"
                 R"({"name": "friction", "between": [0.1, 0.3]}, {"name": "diameter", "between": [0.001, 0.003]},)"
                 R"({"name": "gap", "between": [0.001, 0.005]}, {"name": "speed", "between": [1.0, 1.6]}],)"
                 R"("fixed": {"time_step": 1e-5}, "design": {"kind": "halton", "points": 1}})");
    for (std::size_t row = 0; row < table.rows; ++row) {
        tests::SpreadingPeer q;
        q.friction = table.at("mu", row), q.speed = table.at("v", row);
        q.diameter = table.at("D_mm", row) * 1e-3, q.gap = table.at("gap_mm", row) * 1e-3;
        std::vector<std::string> argv = tests::program_command({"solve", "case.json"});
        for (const auto& [name, value] : {std::pair{"friction", q.friction}, std::pair{"diameter", q.diameter},
                                          std::pair{"gap", q.gap}, std::pair{"speed", q.speed}}) {
            argv.emplace_back("--set");
            argv.push_back(fmt::format("{}={}", name, value));
        }
        const auto us = tests::run_timed(argv, folder.path());
        if (us.code != 0) std::fprintf(stderr, "%s\n", us.out.c_str());
        tests::Ran them;
        if (peer) {
            tests::write_spreading(q, tests::spreading_start(q.diameter, q.friction, 1), folder.path());
            them = tests::run_timed({"liggghts", "-in", "in.spread", "-log", "none"}, folder.path());
            if (them.code != 0)
                std::fprintf(stderr, "liggghts ended with %d:\n%s\n", them.code,
                             them.out.substr(them.out.size() - std::min<std::size_t>(400, them.out.size())).c_str());
        }
        ours_total += us.user_seconds, theirs_total += them.user_seconds;
        fmt::print(
            "{{\"bench\": \"peers\", \"scene\": \"spreading\", \"point\": {}, \"grainsweep_seconds\": {:.3f}, "
            "\"liggghts_seconds\": {:.3f}, \"times_liggghts\": {:.2f}}}\n",
            static_cast<int>(table.at("point", row)), us.user_seconds, them.user_seconds,
            them.user_seconds / us.user_seconds);
        std::fflush(stdout);
    }
    fmt::print(
        "{{\"bench\": \"peers\", \"scene\": \"spreading\", \"point\": \"sum\", \"grainsweep_seconds\": {:.2f}, "
        "\"liggghts_seconds\": {:.2f}, \"times_liggghts\": {:.2f}}}\n",
        ours_total, theirs_total, theirs_total / ours_total);
}

double wall_seconds(const std::vector<std::string>& argv, const std::filesystem::path& folder) {
    const auto start = std::chrono::steady_clock::now();
    const auto ran = tests::run_timed(argv, folder);
    if (ran.code != 0) std::fprintf(stderr, "%s: %d\n%s\n", argv[0].c_str(), ran.code, ran.out.c_str());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void campaign() {
    constexpr std::size_t sample = 24;
    const std::string config = tests::source("configs/wu2020_lds.json");
    const tests::Folder folder;
    const auto planned = tests::run_program({"plan", config, "--format", "json"}, folder.path());
    const auto plan = nlohmann::json::parse(planned.out);
    const auto cases = plan.at("cases").get<double>();
    const double ours_wall = wall_seconds(
        tests::program_command({"run", config, "--db", "sample.db", "--max-cases", "24", "--quiet"}), folder.path());
    double theirs_wall = 0;
    if (tests::installed("liggghts") && tests::installed("parallel")) {
        std::string jobs;
        for (std::size_t k = 0; k < sample; ++k) {
            const auto& row = plan.at("rows").at(k);
            tests::SpreadingPeer q;
            q.friction = row.at("friction"), q.diameter = row.at("diameter");
            q.gap = row.at("gap"), q.speed = row.at("speed");
            const auto job = folder.path() / fmt::format("case_{:02}", k);
            std::filesystem::create_directory(job);
            tests::write_spreading(q, tests::spreading_start(q.diameter, q.friction, k + 1), job);
            jobs += job.string() + "\n";
        }
        folder.write("jobs.txt", jobs);
        theirs_wall = wall_seconds({"parallel", "-j", std::to_string(std::thread::hardware_concurrency()), "-a",
                                    "jobs.txt", "cd {} && liggghts -in in.spread -log none > out.txt"},
                                   folder.path());
    }
    fmt::print(
        "{{\"bench\": \"peers\", \"scene\": \"campaign\", \"sample\": {}, \"grainsweep_wall_seconds\": {:.2f}, "
        "\"liggghts_parallel_wall_seconds\": {:.1f}, \"times\": {:.1f}, \"whole_campaign_hours\": "
        "{{\"grainsweep\": {:.3f}, \"liggghts_parallel\": {:.2f}}}}}\n",
        sample, ours_wall, theirs_wall, theirs_wall / ours_wall, ours_wall / sample * cases / 3600,
        theirs_wall / sample * cases / 3600);
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::string(argv[i]) == "--scene") o.scene = argv[i + 1];
        if (std::string(argv[i]) == "--skins") o.skins.resize(static_cast<std::size_t>(std::stoi(argv[i + 1])), 0.4);
    }
    std::map<double, dem::Setup> beds;
    const auto bed = [&](double spread_of_radii) -> const dem::Setup& {
        if (!beds.contains(spread_of_radii)) {
            tests::BedOptions b;
            b.spread = spread_of_radii;
            if (spread_of_radii > 0) b.per_side = 20, b.layers = 50;
            beds[spread_of_radii] = tests::settled_bed(b);
        }
        return beds.at(spread_of_radii);
    };
    std::optional<dem::Setup> flow;  // in full flow
    const auto chute = [&]() -> const dem::Setup& {
        if (!flow) flow = tests::flowing(bed(0), 26, 0.02);
        return *flow;
    };
    const auto cohesive = [](dem::Setup s) {
        s.material.cohesion = 35e3;
        return s;
    };
    const std::vector<std::pair<std::string, std::function<void(const std::string&)>>> scenes = {
        {"settled_20k", [&](const auto& s) { compare(o, s, bed(0), 1000); }},
        {"chute_20k", [&](const auto& s) { compare(o, s, chute(), 1000); }},
        {"chute_unequal_20k", [&](const auto& s) { compare(o, s, tests::flowing(bed(0.25), 26, 0.02), 1000); }},
        {"cohesive_20k", [&](const auto& s) { compare(o, s, cohesive(bed(0)), 1000); }},
        {"cohesive_chute_20k", [&](const auto& s) { compare(o, s, cohesive(chute()), 1000); }},
        {"settled_180k", [&](const auto& s) { compare(o, s, tests::replicated(bed(0), 3, 3), 200); }},
        {"chute_180k", [&](const auto& s) { compare(o, s, tests::replicated(chute(), 3, 3), 200); }},
        {"chute_statistics", [&](const auto&) { statistics(); }},
        {"spreading", [&](const auto&) { spreading(); }},
        {"campaign", [&](const auto&) { campaign(); }},
    };
    for (const auto& [name, run] : scenes)
        if (o.scene.empty() || o.scene == name) run(name);
    return 0;
}
