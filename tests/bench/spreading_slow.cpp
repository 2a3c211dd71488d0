// A roller against LIGGGHTS 3.8 (tests/reference/walls, section 4 "roller"): 3000 spheres, three spins, forty seeds
// each, since the scatter between runs, 0.005 to 0.014 from sets of ten, decides; minutes: slow_spreading.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/reference_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

using namespace grainsweep;

namespace {

constexpr int seeds = 40;
constexpr double d = 0.002, speed = 0.4, gap = 2 * d, width = 10 * d, settle_time = 0.12;

struct Scatter {
    double sum = 0, squares = 0;
    int n = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        ++n;
    }
    [[nodiscard]] double mean() const { return sum / n; }
    [[nodiscard]] double deviation() const { return std::sqrt((squares - sum * sum / n) / (n - 1)); }
};

/// The values of each run there, by case and quantity.
std::map<std::string, Scatter> reference_runs() {
    std::map<std::string, Scatter> runs;
    for (const char* name : {"walls/ensembles.csv", "walls/ensembles_more_seeds.csv"}) {
        const grainsweep::tests::ReferenceTable table(name);
        for (std::size_t row = 0; row < table.size(); ++row) {
            if (!table.cell(row, "case").starts_with("roller")) continue;
            std::istringstream values(table.cell(row, "values"));
            for (double x = 0; values >> x;) runs[table.cell(row, "case") + " " + table.cell(row, "quantity")].add(x);
        }
    }
    return runs;
}

/// Mean of a series between two travels, m.
double mean_between(const Observations& seen, const char* name, double from, double to) {
    double sum = 0;
    int n = 0;
    for (const auto& sample : seen.series.at(name)) {
        const double travel = sample.time * speed;
        if (travel < from || travel > to) continue;
        sum += sample.value;
        ++n;
    }
    return sum / n;
}

/// Solid fraction 5 to 15 D behind the axis and below the gap, mean over the frames of the reference.
double behind_in_frames(Scene& scene) {
    double sum = 0;
    for (int travel = 55; travel <= 65; ++travel) {
        const double time = travel * 1e-3 / speed, axis = 0.015 - 8 * d + travel * 1e-3;
        scene.advance(settle_time + time);
        for (const auto& x : scene.snapshot().positions)
            if (x[0] > axis - 15 * d && x[0] <= axis - 5 * d && x[2] <= gap) sum += std::numbers::pi / 6 * d * d * d;
    }
    return sum / 11 / (10 * d * width * gap);
}

}  // namespace

TEST(Roller, AgreesWithLiggghts) {
    const auto there = reference_runs();
    for (const int spin : {0, 1, 2}) {
        Scatter flux, solid, whole;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const SceneInfo& info = *campaign::scene_named("powder_spreading");
            Inputs inputs = info.defaults();
            inputs["tool"] = std::string("roller");
            inputs["roller_diameter"] = 16 * d;
            inputs["roller_spin"] = static_cast<double>(spin);
            inputs["gap"] = gap;
            inputs["speed"] = speed;
            inputs["layer_area"] = 3000 * std::numbers::pi / 6 * d * d * d / width;
            inputs["settle_time"] = settle_time;
            inputs["time_step"] = 2e-5;
            inputs["tangential_limit"] = std::string("spring");
            NoArtefacts none;
            const auto scene = info.make(inputs, seed, none);
            const double behind = behind_in_frames(*scene);
            scene->advance(std::numeric_limits<double>::infinity());
            ASSERT_TRUE(scene->health().stable()) << scene->health().reason;
            Observations seen;
            scene->observe(seen);
            flux.add(mean_between(seen, "flux_series", 0.0252, 0.0652));
            solid.add(behind);
            whole.add(seen.scalars.at("solid_behind"));  // from 50 to 70 mm
        }
        std::printf("spin %d solid_behind of the scene, over other frames: %.4f\n", spin, whole.mean());
        for (const auto& [name, here] : {std::pair{"flux", flux}, std::pair{"solid_behind", solid}}) {
            const Scatter& other = there.at("roller_spin" + std::to_string(spin) + " " + name);
            const double s =
                std::sqrt((here.squares - here.sum * here.mean() + other.squares - other.sum * other.mean()) /
                          (here.n + other.n - 2));
            const double allowed = 3 * s * std::sqrt(1.0 / here.n + 1.0 / other.n);
            std::printf("spin %d %-12s here %.4f +- %.4f (%d), LIGGGHTS %.4f +- %.4f (%d), difference %+.4f of %.4f\n",
                        spin, name, here.mean(), here.deviation() / std::sqrt(here.n), here.n, other.mean(),
                        other.deviation() / std::sqrt(other.n), other.n, here.mean() - other.mean(), allowed);
            EXPECT_LE(std::abs(here.mean() - other.mean()), allowed) << spin << " " << name;
        }
    }
}
