// What the TPMS scene skips and what that saves; and its error against its cost.
//
//   bench_tpms [--edge N] [--seeds N] [--part skips|skin|accuracy]
//
//   skips      wall spheres never reached, frozen pairs, particles that left, the early end, powder at rest: each line
//              names the work with and without the skip, and how far the answers differ (tests prove the first three
//              to the last bit; powder at rest is skipped here with a rest speed of 0.001, by default it is not)
//   skin       cost of the neighbour skins, mixed precision; a list misses no contact whatever its skin
//   accuracy   a P cell over packings: retention at 1 t* of steps and precisions, and, jammed by cohesion, share of the
//              powder at rest and retention at 3 t*; against a step a quarter of the study's in double precision
//              (jammed: mixed) from the same packings, the standard error of the difference beside it
//
// Cost is processor time of this thread. One JSON line per figure.
#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/particles/near_pairs.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/tpms_cells.hpp"
#include "tests/support/tpms_filling.hpp"
#include "tests/support/trade_off.hpp"

using namespace grainsweep;
using dem::Method;

namespace {

using tests::cell_of;
constexpr double diameter = tests::cell_diameter;

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Run {
    double seconds = 0;
    dem::Work work;
};

Run run(const dem::Setup& setup, std::int64_t steps, double skin = 0) {
    Method method;
    method.precision = Method::Precision::mixed;
    method.skin = skin;
    const auto engine = dem::make_engine(setup, method);
    const double start = processor_seconds();
    engine->run(steps);
    if (!engine->fault().empty()) std::fprintf(stderr, "%s\n", engine->fault().c_str());
    return {processor_seconds() - start, engine->work()};
}

void print_skip(const char* skip, double without, double with, const char* unit, double difference) {
    std::printf(
        "{\"bench\": \"tpms\", \"skip\": \"%s\", \"without\": %.6g, \"with\": %.6g, \"unit\": \"%s\", "
        "\"saved\": %.3f, \"difference\": %.3g}\n",
        skip, without, with, unit, 1 - with / without, difference);
    std::fflush(stdout);
}

Observations answer_of(Inputs inputs, double& seconds, double& steps, std::string& fault) {
    NoArtefacts none;
    const auto scene = campaign::scene_named("tpms_discharge")->make(inputs, 1, none);
    const double start = processor_seconds();
    scene->advance(1e9);
    seconds = processor_seconds() - start;
    steps = scene->particle_steps();
    fault = scene->health().reason;
    Observations answer;
    scene->observe(answer);
    return answer;
}

Inputs cell_inputs(double edge) {
    Inputs inputs = campaign::scene_named("tpms_discharge")->defaults();
    inputs["edge"] = edge;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 9.81 * 100 / edge;
    return inputs;
}

void skips(double edge) {
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const machine::LevelSetRegion shell{geometry::TpmsCell::schwarz_p, edge, 4, +1};
    const auto whole = particles::fill_tpms(packing, shell, 0), lean = particles::fill_tpms(packing, shell, 0.9);
    constexpr std::int64_t steps = 2000;
    print_skip("wall spheres never reached", run(cell_of(whole, edge, 0, 0), steps).seconds,
               run(cell_of(lean, edge, 0, 0), steps).seconds, "s", 0);

    double all = 0, useful = 0;
    std::vector<std::array<double, 3>> positions = lean.mobile;
    positions.insert(positions.end(), lean.wall.begin(), lean.wall.end());
    particles::for_each_near_pair(positions, 1.2, [&](std::size_t i, std::size_t j, double) {
        all += 1;
        useful += i < lean.mobile.size() || j < lean.mobile.size() ? 1 : 0;
    });
    print_skip("pairs of frozen spheres", all, useful, "pairs within 1.2 diameters at the start", 0);

    const double t_star = std::sqrt(2 * edge * diameter / (9.81 * 100 / edge));
    const auto discharge = static_cast<std::int64_t>(4 * t_star / 1e-6);
    print_skip("particles that left", run(cell_of(lean, edge, 0, 20), discharge).seconds,
               run(cell_of(lean, edge, 0, 0), discharge).seconds, "s over 4 t*", 0);

    Inputs inputs = cell_inputs(edge);
    inputs["cohesion"] = 35e3;
    double early_cost = 0, late_cost = 0, steps_done = 0;
    std::string fault;
    const auto early = answer_of(inputs, early_cost, steps_done, fault);
    inputs["settle_rule"] = std::string("none");
    const auto late = answer_of(inputs, late_cost, steps_done, fault);
    print_skip("early end of a jammed cell", late_cost, early_cost, "s to 10 t*",
               early.scalars.at("retention") - late.scalars.at("retention"));

    // The answers are those of two realisations: a jammed cell of 20 diameters scatters by 0.03.
    for (const double cohesion : {35e3, 0.0}) {
        inputs["cohesion"] = cohesion;
        inputs["end_time"] = 4.05;
        inputs["rest_speed"] = 0.0;
        double plain_cost = 0, rest_cost = 0;
        const auto plain = answer_of(inputs, plain_cost, steps_done, fault);
        inputs["rest_speed"] = 1e-3;
        const auto resting = answer_of(inputs, rest_cost, steps_done, fault);
        print_skip(cohesion > 0 ? "powder at rest in a jammed cell" : "powder at rest in a cell that empties",
                   plain_cost, rest_cost, "s to 4 t*", resting.scalars.at("retention") - plain.scalars.at("retention"));
    }
}

void skins(double edge) {
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const machine::LevelSetRegion shell{geometry::TpmsCell::schwarz_p, edge, 4, +1};
    const dem::Setup setup = cell_of(particles::fill_tpms(packing, shell, 0.9), edge, 20e3, 0);
    for (const double skin : {0.0, 0.05, 0.1, 0.2, 0.4, 0.7}) {
        const Run r = run(setup, 3000, skin * diameter);
        std::printf(
            "{\"bench\": \"tpms\", \"skin_in_diameters\": \"%s\", \"ns_per_particle_step\": %.1f, "
            "\"rebuilds\": %lld}\n",
            skin > 0 ? std::to_string(skin).c_str() : "adapted", 1e9 * r.seconds / r.work.particle_steps,
            static_cast<long long>(r.work.rebuilds));
        std::fflush(stdout);
    }
}

double sample_at(const Observations& answer, const char* series, double t) {
    return std::ranges::lower_bound(answer.series.at(series), t - 0.009, {}, &Sample::time)->value;
}

struct Numerics {
    const char* name;
    double step;
    const char* precision;
};

/// A series of the answer at a time, over the settings, the first of which is the reference.
struct Measured {
    const char* name;
    const char* series;
    double t_star;
    double cohesion;
};

void accuracy(double edge, int seeds, const Measured& measured, const std::vector<Numerics>& all) {
    std::vector<std::vector<double>> found(all.size());
    std::vector<tests::Setting> settings;
    for (std::size_t k = 0; k < all.size(); ++k) {
        tests::Setting s;
        s.scene = "tpms_discharge";
        s.name = all[k].name;
        s.measured = measured.name;
        s.is_reference = k == 0;
        for (int seed = 1; seed <= seeds; ++seed) {
            Inputs inputs = cell_inputs(edge);
            inputs["packing_seed"] = std::int64_t{seed};
            inputs["end_time"] = measured.t_star + 0.05;
            inputs["settle_rule"] = std::string("none");
            inputs["cohesion"] = measured.cohesion;
            inputs["time_step"] = all[k].step;
            inputs["precision"] = std::string(all[k].precision);
            double seconds = 0, steps = 0;
            std::string fault;
            const auto answer = answer_of(inputs, seconds, steps, fault);
            s.cost += seconds / seeds;
            s.unstable = s.unstable || !fault.empty();
            if (fault.empty()) found[k].push_back(sample_at(answer, measured.series, measured.t_star));
        }
        if (k > 0 && !s.unstable) {
            double sum = 0, square = 0, reference = 0;
            const double n = seeds;
            for (std::size_t i = 0; i < found[k].size(); ++i) {
                const double difference = found[k][i] - found[0][i];
                sum += difference, square += difference * difference, reference += found[0][i];
            }
            s.error = sum / reference;
            s.uncertainty = std::sqrt(std::max(0.0, square - sum * sum / n) / (n - 1) / n) / (reference / n);
        }
        settings.push_back(s);
    }
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    std::fflush(stdout);
}

void accuracy(double edge, int seeds) {
    accuracy(edge, seeds, {"retention at 1 t*", "retention_series", 1, 0},
             {{"reference", 2.5e-7, "double"},
              {"step 0.25 us", 2.5e-7, "mixed"},
              {"step 0.5 us", 5e-7, "mixed"},
              {"step 1 us", 1e-6, "mixed"},
              {"step 1 us double", 1e-6, "double"},
              {"step 2 us", 2e-6, "mixed"},
              {"step 3 us", 3e-6, "mixed"},
              {"step 4 us", 4e-6, "mixed"}});
    const std::vector<Numerics> steps = {{"reference", 2.5e-7, "mixed"},
                                         {"step 0.5 us", 5e-7, "mixed"},
                                         {"step 1 us", 1e-6, "mixed"},
                                         {"step 2 us", 2e-6, "mixed"},
                                         {"step 3 us", 3e-6, "mixed"}};
    accuracy(edge, seeds, {"jammed: share at rest at 3 t*", "at_rest_series", 3, 35e3}, steps);
    accuracy(edge, seeds, {"jammed: retention at 3 t*", "retention_series", 3, 35e3}, steps);
}

}  // namespace

int main(int argc, char** argv) {
    double edge = 20;
    int seeds = 8;
    std::string part;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i], value = argv[i + 1];
        if (name == "--edge") edge = std::stod(value);
        if (name == "--seeds") seeds = std::stoi(value);
        if (name == "--part") part = value;
    }
    if (part.empty() || part == "skips") skips(edge);
    if (part.empty() || part == "skin") skins(edge);
    if (part.empty() || part == "accuracy") accuracy(edge, seeds);
    return 0;
}
