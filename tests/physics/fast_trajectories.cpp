// One, two and three spheres against LIGGGHTS 3.8.0 (tests/reference/trajectories), mixed precision: positions to 1e-6
// diameters, velocities to 3e-6 of the largest. Single precision rounds every force to 1e-7; a collision sums some
// hundred of them.
//
// The head-on pairs (a, d) start so that they touch after a whole number of steps: the first overlap is zero up to the
// rounding of positions, and the damping there goes as overlap^(1/4): 1e-8 diameters more or less decide about 1e-2 of
// the damping of one step. Hence 3e-4 there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/places.hpp"
#include "tests/support/trajectory_case.hpp"

namespace grainsweep::tests::fast_trajectories_test {

using nlohmann::json;

using Rows = std::vector<std::vector<double>>;  // step, t, id, x y z, vx vy vz, omega x y z, force x y z

Rows read_rows(const std::string& name) {
    std::ifstream in(tests::reference("trajectories/" + name + ".csv"));
    std::string line;
    std::getline(in, line);
    Rows rows;
    while (std::getline(in, line)) {
        std::stringstream cells(line);
        std::string cell;
        rows.emplace_back();
        while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
    }
    return rows;
}

/// In a room of some diameters, as a scene has: positions are resolved to its size over 2^31.
dem::Setup setup_of(const json& c) {
    dem::Setup s = tests::setup_of(c);
    double largest = 0;
    for (const auto& sphere : s.spheres) largest = std::max(largest, sphere.radius);
    for (std::size_t a = 0; a < 3; ++a) {
        s.domain.low[a] = -40 * largest;
        s.domain.high[a] = 40 * largest;
    }
    return s;
}

TEST(FastTrajectories, AgreeWithLiggghts) {
    std::ifstream in(tests::reference("trajectories/cases.json"));
    const json all = json::parse(in);
    int seen = 0;
    for (const auto& [name, c] : all.items()) {
        if (!c["blade"].is_null()) continue;  // a mesh of triangles there, a closest-point bar here
        ++seen;
        const dem::Setup setup = setup_of(c);
        const Rows rows = read_rows(name);
        double fastest = 0;
        for (const auto& r : rows) fastest = std::max({fastest, std::abs(r[6]), std::abs(r[7]), std::abs(r[8])});
        for (const auto path : {dem::Method::Path::baseline, dem::Method::Path::avx2, dem::Method::Path::avx512}) {
            if (!dem::fast::supports(path)) continue;
            const auto engine = dem::fast::make_mixed_engine(setup, path);
            dem::State state;
            double dx = 0, dv = 0, dw = 0;
            for (const auto& r : rows) {
                engine->run(static_cast<std::int64_t>(r[0]) - engine->work().steps);
                engine->state(state);
                const auto i = static_cast<std::size_t>(r[2]) - 1;
                for (std::size_t a = 0; a < 3; ++a) {
                    dx = std::max(dx, std::abs(state.position[i][a] - r[3 + a]) / (2 * state.radius[i]));
                    dv = std::max(dv, std::abs(state.velocity[i][a] - r[6 + a]) / fastest);
                    dw = std::max(dw, std::abs(state.angular_velocity[i][a] - r[9 + a]) * state.radius[i] / fastest);
                }
            }
            EXPECT_EQ(engine->fault(), "") << name;
            const bool on_the_edge = name[0] == 'a' || name[0] == 'd';
            EXPECT_LT(dx, on_the_edge ? 6e-5 : 1e-6) << name;
            EXPECT_LT(dv, on_the_edge ? 3e-4 : 3e-6) << name;
            EXPECT_LT(dw, 3e-6) << name;
        }
    }
    EXPECT_GE(seen, 30);
}

TEST(FastTrajectories, CohesivePairsRestAtTheirEquilibrium) {
    // Hertz against the neck at rest: 4/3 E* sqrt(R*) d^(3/2) = k A(d)
    for (const auto area : {dem::CohesionLaw::sjkr, dem::CohesionLaw::sjkr2, dem::CohesionLaw::paper}) {
        dem::Setup s;
        const double radius = 22.5e-6;
        s.domain = {{-40 * radius, -40 * radius, -40 * radius}, {40 * radius, 40 * radius, 40 * radius}, {}};
        s.material.youngs_modulus = 2.11e6;
        s.material.density = 4430;
        s.material.restitution = 0.5;
        s.material.friction = 0.5;
        s.material.cohesion = 35e3;
        s.material.cohesion_law = area;
        s.gravity = {0, 0, 0};
        s.time_step = 2e-7;
        const double stiffness = 4.0 / 3 * s.material.youngs_modulus / (2 * (1 - 0.3 * 0.3)) * std::sqrt(radius / 2);
        const auto force = [&](double d) {
            const double pi = 3.14159265358979;
            const double neck = area == dem::CohesionLaw::sjkr    ? pi * (4 * radius * d - d * d) / 4
                                : area == dem::CohesionLaw::sjkr2 ? 2 * pi * radius * d
                                                                  : pi * (radius * d - d * d) / 4;
            return stiffness * d * std::sqrt(d) - s.material.cohesion * neck;
        };
        double low = 1e-9 * radius, high = radius;  // attractive at first, repulsive later
        for (int k = 0; k < 100; ++k) (force(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
        const double apart = radius - 0.45 * low;  // near the equilibrium, so that the pair cannot jump off
        s.spheres = {{{-apart, 0, 0}, {}, {}, radius, true}, {{apart, 0, 0}, {}, {}, radius, true}};
        const auto engine = dem::fast::make_mixed_engine(s, dem::Method::Path::best);
        engine->run(40000);
        ASSERT_EQ(engine->fault(), "");
        // positions are multiples of the room over 2^31; two of them
        EXPECT_NEAR(engine->largest_overlap() * 2 * radius, low,
                    1e-6 * low + 2 * (2.05 * 80 + 32) * radius / 4294967296.0);
    }
}

}  // namespace grainsweep::tests::fast_trajectories_test
