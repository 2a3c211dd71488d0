// 637 spheres settling between gates, particle by particle against LIGGGHTS 3.8.
//
// LIGGGHTS 3.8 keeps the tangential displacement of a pair that has separated until its list is rebuilt, so a pair
// that touches again before that starts with an old one (found here: with that memory the two programs agree to
// rounding, without it three pairs differ by 5e-5 diameters at step 500). Ours forgets at separation. The comparison
// therefore runs the engine with LIGGGHTS's memory and its skin, which decides when the list is rebuilt.
#include "solver/dem/clear/combinations.hpp"
#include "solver/dem/engine.hpp"
#include "tests/support/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

using namespace grainsweep;

namespace {

constexpr double diameter = 0.003;
constexpr double reference_skin = 0.2 * diameter;

struct LastingMindlin : dem::Mindlin {
    static constexpr bool remembers_separation = true;
};
using LastingEngine = dem::clear::ClearEngine<dem::Contact<dem::Hertz, LastingMindlin>, dem::clear::equal_spheres>;

dem::Setup mini_scene() {
    dem::Setup s;
    s.domain = {{-0.06, 0, -0.001}, {0.3, 0.03, 0.16}, {false, true, false}};
    s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}, dem::Plane{{0.015, 0, 0}, {1, 0, 0}},
               dem::Plane{{0.105, 0, 0}, {-1, 0, 0}}};
    s.spheres.resize(637);
    std::ifstream in(tests::reference("spreading/init.data"));
    bool velocities = false;
    for (std::string line; std::getline(in, line);) {
        velocities = velocities || line.starts_with("Velocities");
        std::istringstream row(line);
        std::vector<double> numbers;
        for (double x = 0; row >> x;) numbers.push_back(x);
        if (numbers.size() != 7) continue;
        auto& sphere = s.spheres.at(static_cast<std::size_t>(numbers[0]) - 1);
        if (velocities) {
            sphere.velocity = {numbers[1], numbers[2], numbers[3]};
        } else {
            sphere.radius = numbers[2] / 2;
            sphere.position = {numbers[4], numbers[5], numbers[6]};
        }
    }
    return s;
}

/// Distance of every particle from its place in the reference at a step, over the diameter.
std::vector<double> distances(const dem::State& state, const tests::Table& table, std::int64_t step) {
    std::vector<double> result;
    for (std::size_t r = 0; r < table.rows; ++r) {
        if (static_cast<std::int64_t>(table.at("step", r)) != step) continue;
        const auto i = static_cast<std::size_t>(table.at("id", r)) - 1;
        const std::array<double, 3> there = {table.at("x", r), table.at("y", r), table.at("z", r)};
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            double d = state.position[i][k] - there[k];
            if (k == 1) d -= std::round(d / 0.03) * 0.03;
            worst = std::max(worst, std::abs(d) / diameter);
        }
        result.push_back(worst);
    }
    return result;
}

}  // namespace

TEST(DemSettling, FollowsLiggghtsParticleByParticle) {
    if (!exists(tests::reference("spreading/init.data"))) GTEST_SKIP() << "no reference bed here";
    const auto setup = mini_scene();
    const auto table = tests::read_table(tests::reference("spreading/mini_settle.csv"));
    const LastingMindlin mindlin{dem::mindlin(setup.material, setup.time_step)};
    dem::Method method;
    method.skin = reference_skin;
    LastingEngine engine(setup, method, {{dem::hertz(setup.material), mindlin}});
    dem::State state;
    for (const std::int64_t step : {500, 1000}) {
        engine.run(step - engine.work().steps);
        ASSERT_EQ(engine.fault(), "");
        engine.state(state);
        const auto d = distances(state, table, step);
        ASSERT_EQ(d.size(), 637U);
        // A disturbance of 1e-16 m grows to 8e-13 and 4e-12 diameters in the reference itself.
        EXPECT_LT(*std::ranges::max_element(d), 1e-12) << "step " << step;
    }
    // Between steps 1000 and 2000 three clusters part from ours by up to 5e-5 diameters, for a cause not found (the
    // reference sorts its atoms for the first time after step 1000); all others agree to what rounding has grown to.
    engine.run(1000);
    engine.state(state);
    const auto d = distances(state, table, 2000);
    EXPECT_LT(std::ranges::count_if(d, [](double x) { return x > 1e-8; }), 40);
    EXPECT_LT(*std::ranges::max_element(d), 1e-4);
}

// Ours, which forgets at separation, differs only where somebody touched twice.
TEST(DemSettling, ForgettingAtSeparationMattersToFew) {
    if (!exists(tests::reference("spreading/init.data"))) GTEST_SKIP() << "no reference bed here";
    const auto table = tests::read_table(tests::reference("spreading/mini_settle.csv"));
    const auto engine = dem::make_engine(mini_scene(), {});
    engine->run(500);
    dem::State state;
    engine->state(state);
    const auto d = distances(state, table, 500);
    EXPECT_LT(std::ranges::count_if(d, [](double x) { return x > 1e-12; }), 20);
    EXPECT_LT(*std::ranges::max_element(d), 1e-4);
}
