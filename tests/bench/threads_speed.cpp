// One case on several threads beside the same case on one: one JSON line per scene.
//
//   bench_threads [--scene NAME] [--threads N] [--windows N] [--least N] [--large] [--pin]
//
// Two engines of the same case, one thread and N (2), take turns window by window. `speedup` is the ratio of their
// cheapest windows, `speedup_mean` that of all, lists made anew included, in elapsed time: on a machine that does
// something else besides, both are too small. `same`: both end with the same checkpoint. `round_trip_ns`: how long a
// word takes from one core to another and back, the farthest of those that --pin binds the threads to, just before and
// after the windows, the longer one: cores that share a cache hand particles over several times as fast as others, and
// a small case shows it. `round_ns`: how long all threads take to begin and end a round in which they do nothing.
// --least: particles for each thread. Bytes per particle: what the process grew by with each engine. --large adds the
// full-size Schwarz-P cell of configs/gupta_full_cells.json without cohesion, as its powder begins to fall, and a bed
// of a million spheres; --scene full_cell or settled_1M runs one.
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/particles/packing.hpp"
#include "solver/threads/thread_pool.hpp"
#include "tests/support/granular_beds.hpp"
#include "tests/support/tpms_cells.hpp"
#include "tests/support/tpms_filling.hpp"

using namespace grainsweep;
using dem::fast::make_mixed_engine;

namespace {

struct Options {
    std::string scene;
    int threads = 2, windows = 20;
    std::int32_t least = dem::fast::Threads{}.least_particles;
    bool large = false, pin = false;
};

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

unsigned cores() {
    return std::max(1U, std::thread::hardware_concurrency());
}

void bind(pid_t thread, unsigned core) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    sched_setaffinity(thread, sizeof one, &one);
}

/// Binds the threads of this process to the cores, one after the other.
void pin_threads() {
    std::vector<pid_t> threads;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
        threads.push_back(static_cast<pid_t>(std::atoi(entry.path().filename().c_str())));
    std::ranges::sort(threads);
    for (std::size_t k = 0; k < threads.size(); ++k) bind(threads[k], static_cast<unsigned>(k % cores()));
}

/// Nanoseconds for a word from this thread to one on `core` and back, the cheapest of 50 rows of a thousand.
double round_trip(unsigned core) {
    constexpr int rows = 50, row = 1000;
    std::atomic<int> word = 0;
    std::jthread other([&] {
        bind(0, core);
        for (int k = 0; k < rows * row; ++k) {
            while (word.load() != 2 * k + 1) {
            }
            word.store(2 * k + 2);
        }
    });
    double least = 1e300;
    for (int k = 0, r = 0; r < rows; ++r) {
        const double start = seconds();
        for (int q = 0; q < row; ++q, ++k) {
            word.store(2 * k + 1);
            while (word.load() != 2 * k + 2) {
            }
        }
        least = std::min(least, seconds() - start);
    }
    return 1e9 * least / row;
}

/// Of the cores that so many threads are bound to, the one farthest from the first; 0: there is but one.
double farthest_round_trip(int threads) {
    double most = 0;
    for (unsigned core = 1; core < std::min(cores(), static_cast<unsigned>(threads)); ++core)
        most = std::max(most, round_trip(core));
    return most;
}

/// Nanoseconds of an empty round of so many threads, the cheapest of 50 rows of a hundred.
double empty_round(int threads) {
    constexpr int rows = 50, row = 100;
    ThreadPool pool(threads);
    double least = 1e300;
    for (int r = 0; r < rows; ++r) {
        const double start = seconds();
        for (int q = 0; q < row; ++q) pool.run([](int) {});
        least = std::min(least, seconds() - start);
    }
    return 1e9 * least / row;
}

/// Of this process, bytes.
double resident() {
    std::ifstream in("/proc/self/statm");
    double all = 0, pages = 0;
    in >> all >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Timed {
    std::unique_ptr<dem::Engine> engine;
    double least = 1e300, total = 0;

    void run(std::int64_t steps) {
        const double start = seconds();
        engine->run(steps);
        const double spent = seconds() - start;
        least = std::min(least, spent);
        total += spent;
    }
    [[nodiscard]] std::vector<std::byte> bytes() const {
        std::vector<std::byte> all;
        engine->save(all);
        return all;
    }
};

void compare(const Options& o, const std::string& scene, const dem::Setup& setup) {
    const auto particles = static_cast<double>(setup.spheres.size());
    const auto window = static_cast<std::int64_t>(std::clamp(2e6 / particles, 10.0, 100.0));
    double memory[3] = {resident()};
    Timed one, several;
    one.engine = make_mixed_engine(setup, dem::Method::Path::best);
    one.engine->run(2 * window);
    memory[1] = resident();
    several.engine = make_mixed_engine(setup, dem::Method::Path::best, 0, 0, {o.threads, o.least});
    several.engine->run(2 * window);
    memory[2] = resident();
    if (o.pin) pin_threads();
    double far = o.pin ? farthest_round_trip(o.threads) : 0;
    const auto rebuilds = one.engine->work().rebuilds;
    for (int k = 0; k < o.windows; ++k) {
        one.run(window);
        several.run(window);
    }
    if (o.pin) far = std::max(far, farthest_round_trip(o.threads));
    const std::string hand_over = o.pin ? "\"round_trip_ns\": " + std::to_string(std::lround(far)) + ", " : "";
    const double steps = static_cast<double>(window) * o.windows, scale = 1e9 / particles;
    std::printf(
        "{\"bench\": \"threads\", \"scene\": \"%s\", \"particles\": %.0f, \"threads\": %d, \"steps\": %.0f, "
        "\"ns_one\": %.2f, \"ns_several\": %.2f, \"speedup\": %.3f, \"speedup_mean\": %.3f, "
        "%s\"round_ns\": %.0f, \"steps_per_s\": %.1f, \"rebuilds_per_1000\": %.1f, \"bytes_per_particle_one\": %.0f, "
        "\"bytes_per_particle_several\": %.0f, \"same\": %s, \"fault\": \"%s\"}\n",
        scene.c_str(), particles, o.threads, steps, scale * one.least / static_cast<double>(window),
        scale * several.least / static_cast<double>(window), one.least / several.least, one.total / several.total,
        hand_over.c_str(), empty_round(o.threads), static_cast<double>(window) / several.least,
        1000 * static_cast<double>(one.engine->work().rebuilds - rebuilds) / steps, (memory[1] - memory[0]) / particles,
        (memory[2] - memory[1]) / particles, one.bytes() == several.bytes() ? "true" : "false",
        one.engine->fault().c_str());
    std::fflush(stdout);
}

/// With the scene's defaults: a cell of 100 diameters, a shell of 4, packed to 0.62.
dem::Setup full_cell() {
    constexpr double edge = 100, thickness = 4, closest = 0.9;
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const machine::LevelSetRegion shell{geometry::TpmsCell::schwarz_p, edge, thickness, +1};
    return tests::cell_of(particles::fill_tpms(packing, shell, closest), edge, 0, 0);
}

Options read_options(int argc, char** argv) {
    Options o;
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        const auto value = [&] { return i + 1 < argc ? argv[++i] : ""; };
        if (name == "--scene")
            o.scene = value();
        else if (name == "--threads")
            o.threads = std::atoi(value());
        else if (name == "--windows")
            o.windows = std::max(1, std::atoi(value()));
        else if (name == "--least")
            o.least = std::atoi(value());
        else if (name == "--large")
            o.large = true;
        else if (name == "--pin")
            o.pin = true;
        else
            throw std::invalid_argument("no option '" + name +
                                        "': there are --scene, --threads, --windows, --least, --large, --pin");
    }
    return o;
}

}  // namespace

int main(int argc, char** argv) try {
    const Options o = read_options(argc, argv);
    const auto wanted = [&](const char* name) { return o.scene.empty() || o.scene == name; };
    const auto run = [&](const char* name, const std::function<dem::Setup()>& setup) {
        if (wanted(name)) compare(o, name, setup());
    };
    dem::Setup bed, chute;
    const auto chosen = [&](const char* name) { return o.scene == name || (o.large && o.scene.empty()); };
    if (wanted("settled_20k") || wanted("settled_180k") || chosen("settled_1M")) bed = tests::settled_bed({});
    if (wanted("chute_20k") || wanted("chute_180k")) chute = tests::flowing(tests::settled_bed({}), 26, 0.02);
    run("small_chute_2k", [] { return tests::flowing(tests::small_chute(1), 26, tests::small_chute_time); });
    run("settled_20k", [&] { return bed; });
    run("chute_20k", [&] { return chute; });
    run("chute_unequal_20k", [] {
        tests::BedOptions b;
        b.spread = 0.25, b.per_side = 20, b.layers = 50;
        return tests::flowing(tests::settled_bed(b), 26, 0.02);
    });
    if (wanted("drum") || wanted("drum_mesh")) {
        const dem::Setup drum = tests::turning_drum();
        run("drum", [&] { return drum; });
        run("drum_mesh", [&] { return tests::of_triangles(drum); });
    }
    run("settled_180k", [&] { return tests::replicated(bed, 3, 3); });
    run("chute_180k", [&] { return tests::replicated(chute, 3, 3); });
    if (chosen("full_cell")) compare(o, "full_cell", full_cell());
    if (chosen("settled_1M")) compare(o, "settled_1M", tests::replicated(bed, 7, 7));
    return 0;
} catch (const std::invalid_argument& wrong) {
    std::fprintf(stderr, "%s\n", wrong.what());
    return 2;
}
