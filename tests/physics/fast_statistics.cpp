// Where single trajectories have diverged, statistics must not: beds of the same recipe, settled by the mixed engine
// and by the plain double-precision calculation from different seeds, have the same height and coordination within
// the scatter between seeds.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"

namespace grainsweep::tests::fast_statistics_test {

constexpr double diameter = 1e-3;
constexpr int particles = 180;

dem::Setup falling_bed(std::uint64_t seed) {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.friction = 0.3;
    s.domain = {{0, 0, -2e-3}, {6e-3, 6e-3, 14e-3}, {true, true, false}};
    s.time_step = 1e-5;
    s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    const stats::Stream stream(seed, 3);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    for (int k = 0; k < particles; ++k) {
        const int x = k % 5, y = k / 5 % 5, z = k / 25;
        dem::Sphere p;
        p.radius = diameter / 2;
        p.position = {(x + 0.5) * 1.2e-3 + 0.09e-3 * u(), (y + 0.5) * 1.2e-3 + 0.09e-3 * u(),
                      (z + 0.6) * 1.2e-3 + 0.09e-3 * u()};
        p.velocity = {0.2 * u(), 0.2 * u(), 0.2 * u()};
        s.spheres.push_back(p);
    }
    return s;
}

struct Bed {
    double height = 0;        ///< mean, diameters
    double coordination = 0;  ///< touching partners per particle
};

Bed describe(const std::vector<dem::Vec3>& x) {
    Bed b;
    for (std::size_t i = 0; i < x.size(); ++i) {
        b.height += x[i][2] / diameter / particles;
        for (std::size_t j = 0; j < i; ++j) {
            double square = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                double d = x[i][a] - x[j][a];
                if (a < 2) d -= 6e-3 * std::nearbyint(d / 6e-3);
                square += d * d;
            }
            if (square < diameter * diameter) b.coordination += 2.0 / particles;
        }
    }
    return b;
}

struct Moments {
    double mean = 0, square = 0;
    int n = 0;
    void add(double x) { mean += x, square += x * x, ++n; }
    [[nodiscard]] double average() const { return mean / n; }
    [[nodiscard]] double variance() const { return (square - mean * mean / n) / (n - 1); }
};

void expect_equal(const Moments& a, const Moments& b, const char* what) {
    const double error = std::sqrt(a.variance() / a.n + b.variance() / b.n);
    EXPECT_LT(std::abs(a.average() - b.average()), 4 * error) << what << ' ' << a.average() << ' ' << b.average();
    EXPECT_LT(error, 0.03 * a.average()) << what << ": too much scatter to tell anything";
}

TEST(FastStatistics, SettledBedsEqualThoseOfDoublePrecision) {
    Moments plain_height, plain_coordination, height, coordination;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        tests::PlainDem plain(falling_bed(seed));
        plain.run(9000);
        const Bed b = describe(plain.position());
        plain_height.add(b.height);
        plain_coordination.add(b.coordination);
    }
    for (std::uint64_t seed = 101; seed <= 124; ++seed) {
        const auto engine = dem::fast::make_mixed_engine(falling_bed(seed), dem::Method::Path::best);
        engine->run(9000);
        ASSERT_EQ(engine->fault(), "");
        dem::State s;
        engine->state(s);
        const Bed b = describe(s.position);
        height.add(b.height);
        coordination.add(b.coordination);
    }
    expect_equal(height, plain_height, "height");
    expect_equal(coordination, plain_coordination, "coordination");
    EXPECT_GT(coordination.average(), 3);
}

}  // namespace grainsweep::tests::fast_statistics_test
