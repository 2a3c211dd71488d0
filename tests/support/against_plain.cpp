#include "tests/support/against_plain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"

namespace grainsweep::tests {

using dem::Method;

namespace {

/// What a change of the start by `size` diameters grows to.
struct Growth {
    double position, velocity, spin;
};

Growth growth(const Question& q, const PlainDem& plain, double diameter, double size) {
    dem::Setup moved = q.setup;
    const stats::Stream stream(11, 0);
    std::uint64_t draw = 0;
    for (auto& s : moved.spheres)
        for (double& x : s.position) x += size * diameter * (2 * stream.uniform(draw++) - 1);
    PlainDem other(moved);
    other.run(q.steps);
    Growth g{};
    for (std::size_t i = 0; i < moved.spheres.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            g.position = std::max(g.position, std::abs(other.position()[i][a] - plain.position()[i][a]) / diameter);
            g.velocity = std::max(g.velocity, std::abs(other.velocity()[i][a] - plain.velocity()[i][a]));
            g.spin = std::max(g.spin, std::abs(other.angular_velocity()[i][a] - plain.angular_velocity()[i][a]));
        }
    return g;
}

}  // namespace

std::string path_name(Method::Path path) {
    return path == Method::Path::avx512 ? "avx512" : path == Method::Path::avx2 ? "avx2" : "baseline";
}

std::vector<Method::Path> paths() {
    std::vector<Method::Path> all;
    for (const auto p : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512})
        if (dem::fast::supports(p)) all.push_back(p);
    return all;
}

dem::State plain_state(const PlainDem& plain, const dem::State& like) {
    dem::State s = like;
    for (std::size_t k = 0; k < like.id.size(); ++k) {
        const auto i = static_cast<std::size_t>(like.id[k]);
        s.position[k] = plain.position()[i];
        s.velocity[k] = plain.velocity()[i];
        s.angular_velocity[k] = plain.angular_velocity()[i];
    }
    return s;
}

void compare_with_plain(const Question& q) {
    PlainDem plain(q.setup);
    plain.run(q.steps);
    double diameter = 0;
    for (const auto& s : q.setup.spheres) diameter = std::max(diameter, 2 * s.radius);
    const Growth g = growth(q, plain, diameter, 1e-7);
    ASSERT_LT(g.position, 1e-3) << q.name << " is too long to compare step by step";
    for (const auto path : paths()) {
        SCOPED_TRACE(q.name + " " + path_name(path));
        const auto engine = dem::fast::make_mixed_engine(q.setup, path);
        dem::State state;
        engine->run(q.steps);
        engine->state(state);
        ASSERT_EQ(engine->fault(), "");
        ASSERT_EQ(state.id.size(), q.setup.spheres.size());
        const dem::State expected = plain_state(plain, state);
        EXPECT_LT(position_difference(state, expected, q.setup.domain, diameter), 10 * g.position);
        EXPECT_LT(velocity_difference(state, expected), 10 * g.velocity);
        EXPECT_LT(spin_difference(state, expected), 10 * g.spin + 1e-4);
        EXPECT_NEAR(engine->largest_overlap(), plain.largest_overlap(), 20 * g.position);
    }
}

}  // namespace grainsweep::tests
