// Cost of a DEM step: one JSON line per scene and instruction path.
//
//   bench_dem [--scene NAME] [--path avx2|avx512] [--steps N] [--bed FILE --angle DEGREES]
//
// Besides the scenes: `laws`, the step of one settled bed under every combination of laws that is compiled; `rebuild`,
// making the lists anew; `pairs`, what a particle costs by itself and what a contact adds; `kinds`, the drum with one
// kind of spheres and with two that differ in friction, in turns.
//
// ns_min is the cheapest window of a hundred steps, ns_mean all of them, lists included, in processor time of this
// thread. Each phase of a sweep (sift, meet, scatter, advance_range) is a function of its own: `perf record` splits
// the time without slowing the loop.
#include <ctime>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/granular_beds.hpp"
#include "tests/support/peer_programs.hpp"

using namespace grainsweep;
using dem::Method;

namespace {

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

const std::map<std::string, Method::Path> path_names = {
    {"baseline", Method::Path::baseline}, {"avx2", Method::Path::avx2}, {"avx512", Method::Path::avx512}};

/// Runs `steps` steps in windows of a hundred and prints their cost.
void measure(const std::string& scene, const std::string& path, dem::Engine& engine, std::int64_t steps) {
    constexpr std::int64_t window = 100;
    const dem::Work before = engine.work();
    const auto particles = static_cast<double>(engine.size());
    double least = 1e300, total = 0;
    for (std::int64_t s = 0; s < steps; s += window) {
        const double start = processor_seconds();
        engine.run(window);
        const double spent = processor_seconds() - start;
        least = std::min(least, spent);
        total += spent;
    }
    const dem::Work after = engine.work();
    const auto done = static_cast<double>(after.steps - before.steps);
    std::printf(
        "{\"bench\": \"dem_speed\", \"scene\": \"%s\", \"precision\": \"mixed\", \"path\": \"%s\", "
        "\"particles\": %.0f, \"steps\": %.0f, \"ns_min\": %.2f, \"ns_mean\": %.2f, "
        "\"million_particle_steps_per_s\": %.1f, \"pairs_per_particle\": %.2f, \"rebuilds_per_1000\": %.1f, "
        "\"fault\": \"%s\"}\n",
        scene.c_str(), path.c_str(), particles, done, 1e9 * least / window / particles, 1e9 * total / done / particles,
        1e-6 * done * particles / total, (after.pair_visits - before.pair_visits) / done / particles,
        1000 * static_cast<double>(after.rebuilds - before.rebuilds) / done, engine.fault().c_str());
    std::fflush(stdout);
}

struct Options {
    std::string scene, path, bed;
    double angle = 0;
    std::int64_t steps = 1000;
};

Options read_options(int argc, char** argv) {
    Options o;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i], value = argv[i + 1];
        if (name == "--scene")
            o.scene = value;
        else if (name == "--path")
            o.path = value;
        else if (name == "--bed")
            o.bed = value;
        else if (name == "--angle")
            o.angle = std::strtod(value.c_str(), nullptr);
        else if (name == "--steps")
            o.steps = std::strtol(value.c_str(), nullptr, 10);
    }
    return o;
}

void run_everywhere(const Options& o, const std::string& scene, const dem::Setup& setup, std::int64_t steps) {
    for (const auto& [name, path] : path_names) {
        if (!dem::fast::supports(path) || (!o.path.empty() && o.path != name)) continue;
        const auto engine = dem::fast::make_mixed_engine(setup, path);
        engine->run(300);
        measure(scene, name, *engine, steps);
    }
}

void spread(const Options& o, const std::string& scene, double diameter, double gap) {
    for (const auto& [name, path] : path_names) {
        if (!dem::fast::supports(path) || (!o.path.empty() && o.path != name)) continue;
        const auto engine = dem::fast::make_mixed_engine(tests::spreading_start(diameter, 0.2, 1), path);
        measure(scene + "_settling", name, *engine, 15000);
        engine->set_walls(tests::spreading_blade(gap, 1.4));
        measure(scene + "_sweeping", name, *engine, 5000);
    }
}

/// The same bed, 200 steps each, under every law: what is absent must cost nothing.
void laws(const Options& o, const dem::Setup& bed, const dem::Setup& unequal) {
    const auto run = [&](const char* name, dem::Setup setup, const std::function<void(dem::Setup&)>& change) {
        change(setup);
        run_everywhere(o, std::string("law_") + name, setup, 400);
    };
    const auto unfrozen = [](dem::Setup& s) {
        std::erase_if(s.spheres, [](const dem::Sphere& p) { return !p.mobile; });
        s.gravity = {};
    };
    run("frictionless", bed, [](auto& s) { s.material.friction = 0; });
    run("friction", bed, [](auto&) {});
    run("friction_no_frozen", bed, unfrozen);
    run("friction_sjkr", bed, [](auto& s) { s.material.cohesion = 35e3; });
    run("friction_sjkr2", bed, [](auto& s) {
        s.material.cohesion = 35e3;
        s.material.cohesion_law = dem::CohesionLaw::sjkr2;
    });
    run("friction_rolling", bed, [](auto& s) { s.material.rolling_friction = 0.1; });
    run("unequal_friction", unequal, [](auto&) {});
    run("unequal_friction_sjkr", unequal, [](auto& s) { s.material.cohesion = 35e3; });
}

void rebuild(const Options& o, const dem::Setup& bed) {
    for (const auto& [name, path] : path_names) {
        if (!dem::fast::supports(path) || (!o.path.empty() && o.path != name)) continue;
        const auto engine = dem::fast::make_mixed_engine(bed, path);
        engine->run(300);
        double least = 1e300;
        for (int k = 0; k < 20; ++k) {
            const double start = processor_seconds();
            engine->remove({});  // none, but lists and forces anew
            least = std::min(least, processor_seconds() - start);
        }
        std::printf(
            "{\"bench\": \"dem_speed\", \"scene\": \"rebuild\", \"path\": \"%s\", \"particles\": %zu, "
            "\"ns_per_particle\": %.1f}\n",
            name.c_str(), engine->size(), 1e9 * least / static_cast<double>(engine->size()));
        std::fflush(stdout);
    }
}

/// Processor nanoseconds per particle and step, least of ten windows.
double step_cost(const dem::Setup& setup, dem::Method::Path path) {
    const auto engine = dem::fast::make_mixed_engine(setup, path);
    engine->run(200);
    double least = 1e300;
    for (int k = 0; k < 10; ++k) {
        const double start = processor_seconds();
        engine->run(50);
        least = std::min(least, processor_seconds() - start);
    }
    return 1e9 * least / 50 / static_cast<double>(engine->size());
}

void pairs(const Options& o, const dem::Setup& bed) {
    dem::State state;
    dem::fast::make_mixed_engine(bed, dem::Method::Path::best)->state(state);
    const double contacts = tests::figures_of(state, bed).coordination / 2;
    for (const auto& [name, path] : path_names) {
        if (!dem::fast::supports(path) || (!o.path.empty() && o.path != name)) continue;
        const double alone = step_cost(tests::loose_gas(27), path), together = step_cost(bed, path);
        std::printf(
            "{\"bench\": \"dem_speed\", \"scene\": \"pairs\", \"path\": \"%s\", \"ns_per_lone_particle\": "
            "%.2f, \"ns_per_contact\": %.2f, \"contacts_per_particle\": %.2f}\n",
            name.c_str(), alone, (together - alone) / contacts, contacts);
        std::fflush(stdout);
    }
}

/// Every other sphere has another friction.
dem::Setup of_two_kinds(dem::Setup s) {
    for (std::size_t i = 1; i < s.spheres.size(); i += 2) s.spheres[i].kind = 1;
    const auto rubbing = [&](double friction) {
        dem::Material m = s.material;
        m.friction = friction;
        return m;
    };
    const double friction = s.material.friction;
    s.kinds = {{s.material.density, s.material.density},
               {rubbing(friction), rubbing(0.9 * friction), rubbing(0.8 * friction)}};
    for (dem::Wall& wall : s.walls) {
        const double at_wall = wall.surface.friction.value_or(friction);
        wall.materials = {rubbing(at_wall), rubbing(0.9 * at_wall)};
    }
    return s;
}

void kinds(const Options& o, const dem::Setup& drum) {
    constexpr std::int64_t window = 100;
    for (const auto& [name, path] : path_names) {
        if (!dem::fast::supports(path) || (!o.path.empty() && o.path != name)) continue;
        const std::unique_ptr<dem::Engine> engines[] = {dem::fast::make_mixed_engine(drum, path),
                                                        dem::fast::make_mixed_engine(of_two_kinds(drum), path)};
        double least[2] = {1e300, 1e300}, total[2] = {};
        for (const auto& engine : engines) engine->run(300);
        for (std::int64_t s = 0; s < o.steps; s += window)
            for (std::size_t k = 0; k < 2; ++k) {
                const double start = processor_seconds();
                engines[k]->run(window);
                const double spent = processor_seconds() - start;
                least[k] = std::min(least[k], spent);
                total[k] += spent;
            }
        const double per_step = 1e9 / static_cast<double>(window) / static_cast<double>(drum.spheres.size());
        const double windows = static_cast<double>(o.steps) / window;
        std::printf(
            "{\"bench\": \"dem_speed\", \"scene\": \"kinds\", \"path\": \"%s\", \"ns_min_one\": %.2f, \"ns_min_two\": "
            "%.2f, \"ns_mean_one\": %.2f, \"ns_mean_two\": %.2f, \"two_to_one\": %.3f, \"fault\": \"%s\"}\n",
            name.c_str(), per_step * least[0], per_step * least[1], per_step * total[0] / windows,
            per_step * total[1] / windows, least[1] / least[0], (engines[0]->fault() + engines[1]->fault()).c_str());
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const Options o = read_options(argc, argv);
    if (!o.bed.empty()) {
        run_everywhere(o, o.bed, tests::tilted(tests::read_bed(o.bed), o.angle), o.steps);
        return 0;
    }
    std::map<double, dem::Setup> beds;  // each settled once
    const auto bed = [&](double spread_of_radii) -> const dem::Setup& {
        if (!beds.contains(spread_of_radii)) {
            tests::BedOptions b;
            b.spread = spread_of_radii;
            if (spread_of_radii > 0) b.per_side = 20, b.layers = 50;
            beds[spread_of_radii] = tests::settled_bed(b);
        }
        return beds.at(spread_of_radii);
    };
    std::optional<dem::Setup> drum;
    const auto turning_drum = [&] {
        if (!drum) drum = tests::turning_drum();
        return *drum;
    };
    const std::map<std::string, std::function<void(const std::string&)>> scenes = {
        {"settled_20k", [&](const auto& s) { run_everywhere(o, s, bed(0), o.steps); }},
        {"chute_20k", [&](const auto& s) { run_everywhere(o, s, tests::flowing(bed(0), 26, 0.02), o.steps); }},
        {"chute_unequal_20k",
         [&](const auto& s) { run_everywhere(o, s, tests::flowing(bed(0.25), 26, 0.02), o.steps); }},
        {"cohesive_20k",
         [&](const auto& s) {
             dem::Setup setup = bed(0);
             setup.material.cohesion = 35e3;
             run_everywhere(o, s, setup, o.steps);
         }},
        {"chute_180k",
         [&](const auto& s) {
             run_everywhere(o, s, tests::replicated(tests::flowing(bed(0), 26, 0.02), 3, 3), o.steps / 4);
         }},
        {"loose_gas_20k", [&](const auto& s) { run_everywhere(o, s, tests::loose_gas(27), o.steps); }},
        {"drum", [&](const auto& s) { run_everywhere(o, s, turning_drum(), o.steps); }},
        {"drum_mesh", [&](const auto& s) { run_everywhere(o, s, tests::of_triangles(turning_drum()), o.steps); }},
        {"drum_rolling",
         [&](const auto& s) {
             dem::Setup setup = turning_drum();
             setup.material.rolling_friction = 0.1;
             run_everywhere(o, s, setup, o.steps);
         }},
        {"laws", [&](const auto&) { laws(o, bed(0), bed(0.25)); }},
        {"rebuild", [&](const auto&) { rebuild(o, bed(0)); }},
        {"pairs", [&](const auto&) { pairs(o, bed(0)); }},
        {"kinds", [&](const auto&) { kinds(o, turning_drum()); }},
        {"spreading_1mm", [&](const auto& s) { spread(o, s, 1e-3, 2e-3); }},
        {"spreading_3mm", [&](const auto& s) { spread(o, s, 3e-3, 4e-3); }},
    };
    for (const auto& [name, run] : scenes)
        if (o.scene.empty() || o.scene == name) run(name);
    return 0;
}
