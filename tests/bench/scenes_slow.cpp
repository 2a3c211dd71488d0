// Drum, hopper and heap against LIGGGHTS 3.8.0: means over seeds of the same experiments (tests/reference/walls,
// section 4 of its README), through what a campaign calls. A mean over m seeds must lie within 3 s sqrt(1/m + 1/n) of
// the reference's over n, s the standard deviation of one run: the reference's, pooled over the cases of a scene.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/reference_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using namespace grainsweep;

namespace {

struct Reference {
    double mean = 0;
    int seeds = 0;
    std::vector<double> values;
};

/// By case and quantity: the runs of all tables together.
std::map<std::string, std::map<std::string, Reference>> references() {
    std::map<std::string, std::map<std::string, Reference>> all;
    for (const char* file : {"walls/ensembles.csv", "walls/ensembles_more_seeds.csv"}) {
        const grainsweep::tests::ReferenceTable table(file);
        for (std::size_t row = 0; row < table.size(); ++row) {
            Reference& one = all[table.cell(row, "case")][table.cell(row, "quantity")];
            std::istringstream values(table.cell(row, "values"));
            for (double x = 0; values >> x;) one.values.push_back(x);
        }
    }
    for (auto& [name, quantities] : all)
        for (auto& [quantity, one] : quantities) {
            one.seeds = static_cast<int>(one.values.size());
            one.mean = std::accumulate(one.values.begin(), one.values.end(), 0.0) / one.seeds;
        }
    return all;
}

/// Relative standard deviation of one run, pooled over the cases whose names begin so.
double scatter(const std::map<std::string, std::map<std::string, Reference>>& all, const std::string& scene,
               const std::string& quantity) {
    double squares = 0, freedom = 0;
    for (const auto& [name, quantities] : all) {
        if (!name.starts_with(scene)) continue;
        const auto& one = quantities.at(quantity);
        for (const double x : one.values) squares += (x / one.mean - 1) * (x / one.mean - 1);
        freedom += static_cast<double>(one.values.size()) - 1;
    }
    return std::sqrt(squares / freedom);
}

/// Our observable, the reference's quantity, and what ours is multiplied with.
struct Compared {
    const char* ours;
    const char* theirs;
    double factor = 1;
};

constexpr int seeds = 4;

Inputs of_powder(const SceneInfo& scene, const Inputs& given) {
    Inputs inputs = scene.defaults();
    inputs["size_distribution"] = std::string("uniform");
    inputs["size_spread"] = 0.1;
    inputs["time_step"] = 8e-5;
    inputs["tangential_limit"] = std::string("spring");
    if (const char* precision = std::getenv("GRAINSWEEP_PRECISION")) inputs["precision"] = std::string(precision);
    for (const auto& [name, value] : given) inputs.at(name) = value;
    return inputs;
}

void compare(const std::string& scene, const std::string& name, const Inputs& given,
             const std::vector<Compared>& quantities) {
    static const auto all = references();
    const SceneInfo& info = *campaign::scene_named(scene);
    std::map<std::string, double> mean;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        NoArtefacts none;
        const auto one = info.make(of_powder(info, given), seed, none);
        one->advance(std::numeric_limits<double>::infinity());
        ASSERT_EQ(one->health().reason, "");
        Observations seen;
        one->observe(seen);
        for (const auto& q : quantities) mean[q.ours] += q.factor * seen.scalars.at(q.ours) / seeds;
    }
    const std::string kind = name.substr(0, name.find('_'));
    for (const auto& q : quantities) {
        const Reference& reference = all.at(name).at(q.theirs);
        const double s = scatter(all, kind, q.theirs) * reference.mean;
        const double sigma = s * std::sqrt(1.0 / seeds + 1.0 / reference.seeds);
        std::printf("%-22s %-18s %9.4f LIGGGHTS %9.4f  z %5.2f  (one run scatters by %.3g)\n", name.c_str(), q.ours,
                    mean[q.ours], reference.mean, (mean[q.ours] - reference.mean) / sigma, s);
        EXPECT_NEAR(mean[q.ours], reference.mean, 3 * sigma) << name << " " << q.ours;
    }
}

double rpm_of_froude(double froude) {
    return std::sqrt(froude * 9.81 / 0.075) * 30 / std::numbers::pi;
}

}  // namespace

TEST(ScenesAgainstLiggghts, Drum) {
    for (const auto& [name, froude] : {std::pair("Fr0.02", 0.02), std::pair("Fr0.05", 0.05), std::pair("Fr0.2", 0.2)})
        for (const auto& [tail, friction] : {std::pair("mu0.3", 0.3), std::pair("mu0.6", 0.6)})
            compare("rotating_drum", std::string("drum_") + name + "_" + tail,
                    {{"rpm", rpm_of_froude(froude)},
                     {"friction", friction},
                     {"rolling_friction", 0.1},
                     {"particles", std::int64_t{1644}}},
                    {{"angle_cm", "angle_cm_deg"},
                     {"angle_surface", "angle_surface_deg"},
                     {"surface_speed", "surface_speed_over_omegaR"},
                     {"layer_depth", "layer_over_d"},
                     {"wall_layer_speed", "wall_layer_speed_over_wall"}});
}

TEST(ScenesAgainstLiggghts, Hopper) {
    for (const auto& [name, opening] : {std::pair("D5.5", 5.5), std::pair("D6.75", 6.75), std::pair("D8", 8.0)})
        compare("hopper", std::string("hopper_") + name, {{"opening_size", opening * 0.005}, {"stop_share", 0.52}},
                {{"rate", "rate_kg_s"}, {"rate_scaled", "rate_over_rho_sqrtg_d25"}});
}

TEST(ScenesAgainstLiggghts, Heap) {
    for (const auto& [name, friction] : {std::pair("mu0.2", 0.2), std::pair("mu0.4", 0.4), std::pair("mu0.7", 0.7)})
        for (const auto& [tail, rolling] : {std::pair("mur0.1", 0.1), std::pair("mur0.3", 0.3)})
            compare("heap", std::string("heap_") + name + "_" + tail,
                    {{"friction", friction}, {"rolling_friction", rolling}},
                    {{"angle_moment", "angle_moment_deg"},
                     {"angle", "angle_deg"},
                     {"height", "height_over_d", 200},
                     {"run_out", "r90_over_d", 200}});
}
