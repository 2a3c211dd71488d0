// 637 spheres settling between gates, particle by particle against LIGGGHTS 3.8.
//
// A many-body contact problem multiplies rounding errors: in the reference a disturbance of 1e-16 m grows to 8e-13,
// 4e-12 and 2e-10 diameters after 500, 1000 and 2000 steps. The bounds leave a factor of ten to fifty.
#include "solver/dem/engine.hpp"
#include "tests/support/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

using namespace grainsweep;

namespace {

constexpr double diameter = 0.003;

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

}  // namespace

TEST(DemSettling, FollowsLiggghtsUntilRoundingHasGrown) {
    if (!exists(tests::reference("spreading/init.data"))) GTEST_SKIP() << "no reference bed here";
    const auto setup = mini_scene();
    const auto table = tests::read_table(tests::reference("spreading/mini_settle.csv"));
    const auto engine = dem::make_engine(setup, {});
    const std::map<std::int64_t, double> bounds = {{500, 1e-11}, {1000, 1e-10}, {2000, 1e-8}};
    std::map<std::int64_t, double> worst;
    dem::State state;
    for (std::size_t r = 0; r < table.rows; ++r) {
        const auto step = static_cast<std::int64_t>(table.at("step", r));
        if (!bounds.contains(step)) continue;
        engine->run(step - engine->work().steps);
        ASSERT_EQ(engine->fault(), "");
        engine->state(state);
        const auto i = static_cast<std::size_t>(table.at("id", r)) - 1;
        const std::array<double, 3> there = {table.at("x", r), table.at("y", r), table.at("z", r)};
        for (std::size_t k = 0; k < 3; ++k) {
            double d = state.position[i][k] - there[k];
            if (k == 1) d -= std::round(d / 0.03) * 0.03;
            worst[step] = std::max(worst[step], std::abs(d) / diameter);
        }
    }
    ASSERT_EQ(worst.size(), 3U);
    for (const auto& [step, bound] : bounds) EXPECT_LT(worst[step], bound) << "step " << step;
    for (const auto& [step, d] : worst) std::printf("step %lld: %.2e diameters\n", static_cast<long long>(step), d);
}
