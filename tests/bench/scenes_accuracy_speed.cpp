// Error against cost of the scenes at walls and of the laws: what each level of accuracy does to what is measured, and
// what it costs.
//
//   bench_scenes_accuracy [--scene NAME] [--seeds N] [--double N]
//
// Means over seeds against a step of 0.05 of the limit in mixed precision; differences are taken seed by seed, and
// their standard error stands beside them. Double precision, which costs several times as much, over one in N seeds (0:
// not). Cost is processor time of this thread for a whole case, measuring included. One JSON line per setting.
//
//   drum, hopper, heap   the defaults with diameters +- 10 %: angle_cm, rate, angle_moment
//   roller               a roller against its travel on a rough base: packing_fraction
//   layers               three layers by a blade: packing_fraction of the last
//   jkr, dmt             spreading with adhesion of about the weight of a particle: mfr
//   cdt                  the drum with a constant torque against rolling: angle_cm
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/trade_off.hpp"

using namespace grainsweep;
using tests::Runs;
using tests::Setting;

namespace {

struct Question {
    const char* name;
    const char* scene;
    const char* measured;
    Inputs given;
};

const Inputs spread_sizes = {{"size_distribution", std::string("uniform")}, {"size_spread", 0.1}};

Inputs joined(Inputs a, const Inputs& b) {
    a.insert(b.begin(), b.end());
    return a;
}

std::vector<Question> questions() {
    const Inputs adhesive = {{"surface_energy", 0.14}, {"friction", 0.3}, {"diameter", 0.002}, {"gap", 0.004}};
    const auto by_law = [&](const char* law) { return joined(adhesive, {{"cohesion_law", std::string(law)}}); };
    return {
        {"drum", "rotating_drum", "angle_cm", spread_sizes},
        {"hopper", "hopper", "rate", spread_sizes},
        {"heap", "heap", "angle_moment", spread_sizes},
        {"roller",
         "powder_spreading",
         "packing_fraction",
         {{"tool", std::string("roller")},
          {"roller_spin", 1.0},
          {"roller_diameter", 0.03},
          {"speed", 0.3},
          {"friction", 0.3},
          {"rolling_friction", 0.1},
          {"base", std::string("rough")}}},
        {"layers",
         "powder_spreading",
         "packing_fraction",
         {{"layers", std::int64_t{3}}, {"speed", 0.3}, {"friction", 0.3}, {"rolling_friction", 0.1}}},
        {"jkr", "powder_spreading", "mfr", by_law("jkr")},
        {"dmt", "powder_spreading", "mfr", by_law("dmt")},
        {"cdt", "rotating_drum", "angle_cm", joined(spread_sizes, {{"rolling_law", std::string("cdt")}})},
    };
}

struct Choice {
    std::string name;
    Inputs inputs;
    bool is_reference = false;
    int share = 1;  ///< one in so many seeds
};

std::vector<Choice> choices_of(const SceneInfo& scene, int double_share) {
    std::vector<Choice> choices = {{"step 0.05", {{"time_step_fraction", 0.05}}, true}};
    for (const auto& [name, inputs] : scene.accuracy)  // the set called reference is this step in double precision
        if (name != "reference") choices.push_back({"accuracy " + name, inputs});
    if (double_share > 0)
        choices.push_back({"step 0.2 double", {{"precision", std::string("double")}}, false, double_share});
    return choices;
}

double answer(const SceneInfo& scene, const Question& q, const Inputs& numerics, std::uint64_t seed) {
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] : q.given) inputs.at(name) = value;
    for (const auto& [name, value] : numerics) inputs.at(name) = value;
    NoArtefacts none;
    const auto run = scene.make(inputs, seed, none);
    run->advance(std::numeric_limits<double>::infinity());
    Observations seen;
    run->observe(seen);
    const bool answered = run->health().stable() && seen.scalars.contains(q.measured);
    return answered ? seen.scalars.at(q.measured) : std::numeric_limits<double>::quiet_NaN();
}

void ask(const Question& q, int seeds, int double_share) {
    const SceneInfo& scene = *campaign::scene_named(q.scene);
    std::vector<Setting> settings;
    std::vector<Runs> runs;
    for (const auto& choice : choices_of(scene, double_share)) {
        const int count = std::max(2, seeds / choice.share);
        const double start = tests::processor_seconds();
        Runs values;
        for (int seed = 1; seed <= count; ++seed)
            values.push_back(answer(scene, q, choice.inputs, static_cast<std::uint64_t>(seed)));
        Setting s{q.name, choice.name, q.measured, (tests::processor_seconds() - start) / count};
        s.is_reference = choice.is_reference;
        settings.push_back(s);
        std::fprintf(stderr, "%s, %s: %.5g +- %.2g, %.3g s\n", q.name, s.name.c_str(), tests::mean(values),
                     tests::error_of_mean(values), s.cost);
        runs.push_back(std::move(values));
    }
    tests::compare_means(settings, runs);
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::string wanted;
    int seeds = 6, double_share = 3;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--scene") wanted = argv[i + 1];
        if (name == "--seeds") seeds = std::max(2, std::stoi(argv[i + 1]));
        if (name == "--double") double_share = std::max(0, std::stoi(argv[i + 1]));
    }
    for (const auto& q : questions())
        if (wanted.empty() || wanted == q.name) ask(q, seeds, double_share);
    return 0;
}
