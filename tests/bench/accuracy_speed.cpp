// Error against cost of the DEM: what each numerical setting does to what is measured, and what it costs.
//
//   bench_accuracy [--scene collision|settling|chute|spreading] [--seeds N] [--figure FILE.svg]
//                  [--only TEXT]                      of the settings of spreading, those with TEXT in their names
//   bench_accuracy --lines FILE --figure FILE.svg      draws what earlier runs printed
//
//   collision  512 oblique impacts at once (10 to 85 degrees, spinning): rms error of rebound velocities against the
//              same impacts with a step 400 times finer in double precision
//   settling   a bed of 1,000 spheres settling for 0.1 s: mean height, against the finest step, over seeds
//   chute      a flowing chute of 2,000 spheres at 26 degrees: mean velocity over 10 ms, over starts
//   spreading  mfr over six cases of the spreading scene (gap/D from 1.3 to 2), over seeds
//
// The last three are chaotic: single runs say nothing, means over seeds differ by the bias of the setting, and the
// standard error of that difference stands beside it. Cost is processor time of this thread, every step and list
// included. One JSON line per setting; the figure joins the settings no other beats.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "solver/dem/engine.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/scenes/scene.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/granular_beds.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/trade_off.hpp"

using namespace grainsweep;
using dem::Method;
using tests::compare_means;
using tests::error_of_mean;
using tests::mean;
using tests::processor_seconds;
using tests::Runs;
using tests::Setting;

namespace {

/// A numerical setting of an engine.
struct Numerics {
    std::string name;
    double fraction = 0.2;  ///< of the shorter of Rayleigh and Hertz time
    bool mixed = true;
    double skin = 0;       ///< diameters; 0: the engine's choice
    double stiffness = 1;  ///< factor on Young's modulus
    bool is_reference = false;

    [[nodiscard]] Method method(double diameter) const {
        Method m;
        m.precision = mixed ? Method::Precision::mixed : Method::Precision::double_precision;
        m.skin = skin * diameter;
        return m;
    }
};

/// `exact`: the finest step in double precision; where only statistics count it need not be.
std::vector<Numerics> numerics(double finest, bool exact, bool softened) {
    std::vector<Numerics> all;
    all.push_back({"finest step", finest, !exact, 0, 1, true});
    for (const double f : {0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8}) {
        char name[40];
        std::snprintf(name, sizeof name, "step %.2g", f);
        all.push_back({name, f});
    }
    all.push_back({"step 0.2 double", 0.2, false});
    all.push_back({"step 0.2 skin 0.05", 0.2, true, 0.05});
    all.push_back({"step 0.2 skin 0.3", 0.2, true, 0.3});
    if (softened) {
        all.push_back({"step 0.2 E/10", 0.2, true, 0, 0.1});
        all.push_back({"step 0.2 E x 10", 0.2, true, 0, 10});
    }
    return all;
}

// ---- collision -------------------------------------------------------------------------------------------------

constexpr int pairs = 512;
constexpr double sphere = 2e-3;  // m, of collision and settling

dem::Setup impacts(double fraction, double stiffness) {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.youngs_modulus *= stiffness;
    s.gravity = {0, 0, 0};
    const double pitch = 6 * sphere;
    s.domain = {{0, 0, 0}, {8 * pitch, 8 * pitch, 8 * pitch}, {true, true, true}};
    const double finest =
        std::min(dem::rayleigh_time(s.material, sphere / 2), dem::hertz_contact_time(s.material, sphere / 2, 1.0));
    s.time_step = fraction * finest;
    const stats::Stream stream(11, 1);
    std::uint64_t draw = 0;
    for (int k = 0; k < pairs; ++k) {
        const double angle = (10 + 75.0 * k / (pairs - 1)) * 3.14159265358979 / 180;
        const dem::Vec3 at = {(k % 8 + 0.5) * pitch, (k / 8 % 8 + 0.5) * pitch, (k / 64 + 0.5) * pitch};
        const double gap = sphere * (0.005 + 0.02 * stream.uniform(draw++));  // so that impacts fall anywhere in a step
        for (const int side : {-1, 1}) {
            dem::Sphere p;
            p.radius = sphere / 2;
            p.position = {at[0] + side * 0.5 * (sphere + gap), at[1], at[2]};
            p.velocity = {-side * 0.5 * std::cos(angle), -side * 0.5 * std::sin(angle), 0};
            for (double& w : p.angular_velocity) w = 300 * (2 * stream.uniform(draw++) - 1);
            s.spheres.push_back(p);
        }
    }
    return s;
}

void collision(std::vector<Setting>& all) {
    constexpr double duration = 3e-3;  // s: the slowest pair has met and parted
    dem::State reference, state;
    for (const auto& n : numerics(0.0005, true, false)) {
        const dem::Setup setup = impacts(n.fraction, n.stiffness);
        const double start = processor_seconds();
        const auto engine = dem::make_engine(setup, n.method(sphere));
        engine->run(std::llround(duration / setup.time_step));
        Setting s{"collision", n.name, "rebound velocity", processor_seconds() - start};
        s.is_reference = n.is_reference;
        engine->state(n.is_reference ? reference : state);
        s.unstable = !engine->fault().empty();
        if (!n.is_reference && !s.unstable) {
            double square = 0;
            for (std::size_t i = 0; i < state.id.size(); ++i)
                for (std::size_t a = 0; a < 3; ++a)
                    square += std::pow(state.velocity[i][a] - reference.velocity[i][a], 2);
            s.error = std::sqrt(square / static_cast<double>(state.id.size())) / 0.5;  // each comes at 0.5 m/s
        }
        all.push_back(s);
        std::printf("%s\n", tests::json_line(s).c_str());
        std::fflush(stdout);
    }
}

// ---- settling --------------------------------------------------------------------------------------------------

dem::Setup falling(double fraction, double stiffness, std::uint64_t seed) {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.youngs_modulus *= stiffness;
    constexpr int side = 8;
    const double pitch = 1.2 * sphere;
    s.domain = {{0, 0, -sphere}, {side * pitch, side * pitch, 40 * sphere}, {true, true, false}};
    s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    s.time_step = fraction * std::min(dem::rayleigh_time(s.material, sphere / 2),
                                      dem::hertz_contact_time(s.material, sphere / 2, 1.0));
    const stats::Stream stream(seed, 2);
    std::uint64_t draw = 0;
    for (int k = 0; k < 1000; ++k) {
        dem::Sphere p;
        p.radius = sphere / 2;
        const int at[3] = {k % side, k / side % side, k / side / side};
        for (std::size_t a = 0; a < 3; ++a) {
            p.position[a] = (at[a] + 0.6) * pitch + 0.09 * sphere * (2 * stream.uniform(draw++) - 1);
            p.velocity[a] = 0.2 * (2 * stream.uniform(draw++) - 1);
        }
        s.spheres.push_back(p);
    }
    return s;
}

/// Runs one job per setting and seed; compares the means.
void chaotic(std::vector<Setting>& all, const std::string& scene, const std::string& measured,
             const std::vector<Numerics>& list, int seeds,
             const std::function<double(const Numerics&, std::uint64_t)>& job) {
    std::vector<Setting> settings;
    std::vector<Runs> runs(list.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
        const double start = processor_seconds();
        for (int seed = 1; seed <= seeds; ++seed) runs[k].push_back(job(list[k], static_cast<std::uint64_t>(seed)));
        Setting s{scene, list[k].name, measured, (processor_seconds() - start) / seeds};
        s.is_reference = list[k].is_reference;
        settings.push_back(s);
        std::fprintf(stderr, "%s, %s: %.5g +- %.2g, %.3g s\n", scene.c_str(), s.name.c_str(), mean(runs[k]),
                     error_of_mean(runs[k]), s.cost);
    }
    compare_means(settings, runs);
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    std::fflush(stdout);
    all.insert(all.end(), settings.begin(), settings.end());
}

void settling(std::vector<Setting>& all, int seeds) {
    chaotic(all, "settling", "mean height", numerics(0.02, false, true), seeds,
            [](const Numerics& n, std::uint64_t seed) {
                const dem::Setup setup = falling(n.fraction, n.stiffness, seed);
                const auto engine = dem::make_engine(setup, n.method(sphere));
                engine->run(std::llround(0.1 / setup.time_step));
                if (!engine->fault().empty()) return std::numeric_limits<double>::quiet_NaN();
                dem::State state;
                engine->state(state);
                double height = 0;
                for (const auto& x : state.position) height += x[2] / static_cast<double>(state.id.size());
                return height / sphere;
            });
}

// ---- chute -----------------------------------------------------------------------------------------------------

void chute(std::vector<Setting>& all, int seeds) {
    tests::BedOptions o;
    o.per_side = 10, o.layers = 20;
    const dem::Setup bed = tests::settled_bed(o);
    std::map<std::uint64_t, dem::Setup> starts;
    for (int seed = 1; seed <= seeds; ++seed)  // each start is later in the same flow
        starts[static_cast<std::uint64_t>(seed)] = tests::flowing(bed, 26, 0.02 + 0.004 * seed);
    const double radius = bed.spheres[0].radius;
    chaotic(all, "chute", "mean velocity", numerics(0.02, false, false), seeds,
            [&](const Numerics& n, std::uint64_t seed) {
                dem::Setup setup = starts.at(seed);
                setup.time_step = n.fraction * dem::rayleigh_time(setup.material, radius);
                const auto engine = dem::make_engine(setup, n.method(2 * radius));
                double gained = 0;
                dem::State state;
                for (int part = 0; part < 10; ++part) {
                    engine->run(std::llround(0.001 / setup.time_step));
                    if (!engine->fault().empty()) return std::numeric_limits<double>::quiet_NaN();
                    engine->state(state);
                    double sum = 0, mobile = 0;
                    for (std::size_t i = 0; i < state.id.size(); ++i)
                        if (state.mobile[i] != 0) sum += state.velocity[i][0], ++mobile;
                    gained += sum / mobile / 10;
                }
                return gained;
            });
}

// ---- spreading -------------------------------------------------------------------------------------------------

void spreading(std::vector<Setting>& all, int seeds, const std::string& only) {
    const SceneInfo& scene = *campaign::scene_named("powder_spreading");
    struct Question {
        double friction, diameter, gap, speed;
    };
    const std::vector<Question> questions = {{0.2, 2.0e-3, 3.0e-3, 1.2}, {0.2, 2.0e-3, 4.0e-3, 1.4},
                                             {0.2, 2.5e-3, 5.0e-3, 1.2}, {0.1, 3.0e-3, 4.0e-3, 1.4},
                                             {0.3, 1.5e-3, 3.0e-3, 1.0}, {0.3, 1.5e-3, 2.0e-3, 1.4}};
    struct Choice {
        std::string name;
        Inputs inputs;
        bool is_reference = false;
        int share = 1;  ///< one in so many seeds: the dear ones
    };
    std::vector<Choice> choices;
    choices.push_back({"step 0.05", {{"time_step_fraction", 0.05}}, true});
    for (const double f : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8}) {
        char name[40];
        std::snprintf(name, sizeof name, "step %.2g", f);
        choices.push_back({name, {{"time_step_fraction", f}}});
    }
    choices.push_back({"step 0.2 double", {{"precision", std::string("double")}}, false, 3});
    choices.push_back({"step 0.2 width 5", {{"width", 5.0}}});
    choices.push_back({"step 0.4 width 5", {{"width", 5.0}, {"time_step_fraction", 0.4}}});
    choices.push_back({"step 0.2 width 20", {{"width", 20.0}}});
    choices.push_back({"step 0.2 E/10", {{"youngs_modulus", 2.1e6}}});
    choices.push_back({"step 0.2 E x 10", {{"youngs_modulus", 2.1e8}}});
    choices.push_back({"step 0.2 E x 100", {{"youngs_modulus", 2.1e9}}, false, 6});
    choices.push_back({"step 0.2 settle 0.1", {{"settle_time", 0.1}}});
    for (const auto& [name, inputs] : scene.accuracy)  // the set called reference is finer than this comparison
        if (name != "reference") choices.push_back({"accuracy " + name, inputs});
    if (!only.empty())
        std::erase_if(choices,
                      [&](const Choice& c) { return !c.is_reference && c.name.find(only) == std::string::npos; });
    std::vector<Setting> settings;
    std::vector<Runs> runs(choices.size());
    for (std::size_t k = 0; k < choices.size(); ++k) {
        const double start = processor_seconds();
        NoArtefacts none;
        const int count = std::max(2, seeds / choices[k].share);
        for (int seed = 1; seed <= count; ++seed) {
            double over_questions = 0;  // each question counting alike
            for (const auto& q : questions) {
                Inputs inputs = scene.defaults();
                inputs["friction"] = q.friction, inputs["diameter"] = q.diameter;
                inputs["gap"] = q.gap, inputs["speed"] = q.speed;
                for (const auto& [name, value] : choices[k].inputs) inputs[name] = value;
                const auto run = scene.make(inputs, static_cast<std::uint64_t>(seed), none);
                run->advance(std::numeric_limits<double>::infinity());
                Observations seen;
                run->observe(seen);
                over_questions += run->health().stable()
                                      ? seen.scalars.at("mfr") / static_cast<double>(questions.size())
                                      : std::numeric_limits<double>::quiet_NaN();
            }
            runs[k].push_back(over_questions);
        }
        Setting s{"spreading", choices[k].name, "mfr", (processor_seconds() - start) / count};
        s.is_reference = choices[k].is_reference;
        settings.push_back(s);
        std::fprintf(stderr, "spreading, %s: %.5f +- %.5f, %.3g s\n", s.name.c_str(), mean(runs[k]),
                     error_of_mean(runs[k]), s.cost);
    }
    compare_means(settings, runs);
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    all.insert(all.end(), settings.begin(), settings.end());
}

/// What json_line wrote.
std::vector<Setting> read_lines(const std::string& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file);
    std::vector<Setting> all;
    for (std::string line; std::getline(in, line);) {
        const auto j = nlohmann::json::parse(line);
        if (j.contains("outcome")) continue;
        Setting s{j.at("scene"), j.at("setting"), j.at("measured"), j.at("cost_seconds")};
        s.error = j.at("relative_error"), s.uncertainty = j.at("uncertainty");
        s.is_reference = j.at("reference");
        all.push_back(s);
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    std::string scene, figure, lines, only;
    int seeds = 12;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--scene") scene = argv[i + 1];
        if (name == "--seeds") seeds = std::max(2, std::stoi(argv[i + 1]));
        if (name == "--figure") figure = argv[i + 1];
        if (name == "--only") only = argv[i + 1];
        if (name == "--lines") lines = argv[i + 1];
    }
    std::vector<Setting> all;
    if (!lines.empty()) all = read_lines(lines);
    const auto wanted = [&](const char* name) { return lines.empty() && (scene.empty() || scene == name); };
    if (wanted("collision")) collision(all);
    if (wanted("settling")) settling(all, seeds);
    if (wanted("chute")) chute(all, seeds);
    if (wanted("spreading")) spreading(all, seeds, only);
    tests::mark_dominated(all);
    if (!figure.empty()) tests::draw(all, figure);
    return 0;
}
