// Granular scenes at walls side by side with LIGGGHTS: the same start, law, walls and time step, from the first step to
// the last, one core, in turn.
//
//   bench_walls_peers [--deck NAME] [--skins N]
//
// The decks are the drum, hopper, heap and roller of tests/reference/walls. Neither program writes anything on its way
// but LIGGGHTS a line every 250 steps and one frame at the end, from which a figure is taken that ours is compared by:
// a single run's, so it agrees within the scatter of runs. User and wall seconds are those of the whole calculation,
// its start included; nanoseconds are user seconds over particles times steps. LIGGGHTS with the fastest of several
// list skins (in diameters), ours with its own choice, measured before and after and the slower one taken. Floor of the
// hopper and tube of the heap are triangles in LIGGGHTS; ours has them curved, and of the same triangles. One JSON line
// each; without LIGGGHTS its figures are null, and it is said.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/peer_programs.hpp"
#include "tests/support/process.hpp"
#include "tests/support/wall_decks.hpp"

using namespace grainsweep;

namespace {

struct Measured {
    double nanoseconds = 0;  ///< per particle and step
    double user_seconds = 0, wall_seconds = 0;
    double figure = 0;
    double skin = 0;  ///< diameters
};

double user_seconds() {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

Measured ours(const tests::WallDeck& deck) {
    const double user = user_seconds();
    const auto start = std::chrono::steady_clock::now();
    const auto engine = dem::make_engine(deck.start, {.precision = dem::Method::Precision::mixed});
    engine->run(deck.settle);
    if (!deck.then.empty()) engine->set_walls(deck.then);
    engine->run(deck.steps);
    Measured m;
    m.user_seconds = user_seconds() - user;
    m.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    m.nanoseconds = 1e9 * m.user_seconds / engine->work().particle_steps;
    if (!engine->fault().empty()) std::fprintf(stderr, "%s: %s\n", deck.name.c_str(), engine->fault().c_str());
    dem::State state;
    engine->state(state);
    m.figure = deck.figure(state);
    return m;
}

/// The fastest over the skins.
std::optional<Measured> theirs(const tests::WallDeck& deck, const std::vector<double>& skins) {
    if (!tests::installed("liggghts")) return std::nullopt;
    std::optional<Measured> best;
    const double diameter = 2 * deck.start.spheres[0].radius;
    for (const double skin : skins) {
        const tests::Folder folder;
        tests::write_deck(deck, skin * diameter, folder.path());
        const auto ran = tests::run_timed({"liggghts", "-in", "in.walls", "-log", "none"}, folder.path());
        if (ran.code != 0) {
            std::fprintf(stderr, "liggghts ended with %d:\n%s\n", ran.code,
                         ran.out.substr(ran.out.size() - std::min<std::size_t>(400, ran.out.size())).c_str());
            return std::nullopt;
        }
        const Measured m{1e9 * ran.user_seconds / tests::particle_steps(ran.out), ran.user_seconds, ran.wall_seconds,
                         deck.figure(tests::last_frame(deck, folder.path())), skin};
        if (!best || m.user_seconds < best->user_seconds) best = m;
    }
    return best;
}

std::string as_json(const Measured& m) {
    return fmt::format("{{\"ns\": {:.1f}, \"user_seconds\": {:.2f}, \"wall_seconds\": {:.2f}, \"figure\": {:.4g}}}",
                       m.nanoseconds, m.user_seconds, m.wall_seconds, m.figure);
}

void print(const tests::WallDeck& deck, const char* walls, const Measured& us, const std::optional<Measured>& them) {
    fmt::print(
        "{{\"bench\": \"walls_peers\", \"deck\": \"{}\", \"walls\": \"{}\", \"particles\": {}, \"steps\": {}, "
        "\"measured\": \"{}\", \"grainsweep\": {}, \"liggghts\": {}, \"skin\": {}, \"times_liggghts\": {}}}\n",
        deck.name, walls, deck.start.spheres.size(), deck.settle + deck.steps, deck.measured, as_json(us),
        them ? as_json(*them) : "null", them ? fmt::format("{}", them->skin) : "null",
        them ? fmt::format("{:.2f}", them->nanoseconds / us.nanoseconds) : "null");
    std::fflush(stdout);
}

void compare(const std::vector<std::pair<const char*, tests::WallDeck>>& walls, const std::vector<double>& skins) {
    std::vector<Measured> before;
    for (const auto& [name, deck] : walls) before.push_back(ours(deck));
    const auto them = theirs(walls[0].second, skins);
    for (std::size_t k = 0; k < walls.size(); ++k) {
        const Measured after = ours(walls[k].second);
        print(walls[k].second, walls[k].first, before[k].user_seconds > after.user_seconds ? before[k] : after, them);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::string wanted;
    std::vector<double> skins = {0.2, 0.3, 0.1};
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::string(argv[i]) == "--deck") wanted = argv[i + 1];
        if (std::string(argv[i]) == "--skins") skins.resize(std::clamp<std::size_t>(std::stoul(argv[i + 1]), 1, 3));
    }
    if (!tests::installed("liggghts"))
        std::fprintf(stderr, "LIGGGHTS is not installed (Debian package liggghts): only grainsweep is measured\n");
    using tests::WallsAs;
    const auto asked = [&](const char* name) { return wanted.empty() || wanted == name; };
    if (asked("drum")) compare({{"curved", tests::drum_deck()}}, skins);
    if (asked("hopper"))
        compare(
            {{"curved", tests::hopper_deck(WallsAs::curved)}, {"triangles", tests::hopper_deck(WallsAs::triangles)}},
            skins);
    if (asked("heap"))
        compare({{"curved", tests::heap_deck(WallsAs::curved)}, {"triangles", tests::heap_deck(WallsAs::triangles)}},
                skins);
    if (asked("roller")) compare({{"curved", tests::roller_deck()}}, skins);
    return 0;
}
