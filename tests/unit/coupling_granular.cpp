// Closures of the dense levels against numbers worked out by hand from the printed formulas.
#include "solver/coupling/granular.hpp"
#include "solver/coupling/granular_temperature.hpp"
#include "solver/coupling/hysteretic_spring.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::coupling_granular_test {

using namespace coupling;

constexpr double pi = 3.14159265358979323846;

// xi = 2.5, d = 0.01, e = 0.9, a_max = 0.63, no fluid.
const Granular dry{2.5, 0.01, 0.9, 0.63, 0};

flow::Grid cube(int n) {
    const auto axis = flow::Axis::uniform(n, -0.5, 0.5);
    return {{axis, axis, axis}};
}
constexpr std::array<flow::Side, 2> periodic{flow::Periodic{}, flow::Periodic{}};
const flow::Sides everywhere{periodic, periodic, periodic};

// One particle at every cell centre: every cell holds the fraction v/h^3.
std::vector<Vec3> lattice(int n) {
    std::vector<Vec3> positions;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                positions.push_back({(i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5, (k + 0.5) / n - 0.5});
    return positions;
}

TEST(Granular, RadialDistributionAndSolidsPressure) {
    // (a/a_max)^(1/3) = 1/2 at a = a_max/8: g0 = 2.
    EXPECT_NEAR(dry.radial_distribution(0.63 / 8), 2, 1e-12);
    EXPECT_NEAR(dry.radial_distribution(0.63 * 0.729), 10, 1e-9);
    EXPECT_NEAR(dry.radial_distribution(1e-12), 1, 2e-4);
    // p_s/Theta = 2.5 * 0.07875 (1 + 3.8 * 0.07875 * 2)
    EXPECT_NEAR(dry.pressure(0.63 / 8), 2.5 * 0.07875 * 1.5985, 1e-12);
    const double a = 0.45927;
    EXPECT_NEAR(dry.pressure(a), 2.5 * a * (1 + 3.8 * a * 10), 1e-9);
    // Dilute: an ideal gas.
    EXPECT_NEAR(dry.pressure(1e-9) / (2.5e-9), 1, 1e-8);
    // The limit itself is finite and enormous.
    EXPECT_GT(dry.pressure(0.63), 1e4);
    EXPECT_TRUE(std::isfinite(dry.pressure(0.9)));
}

TEST(Granular, ViscosityConductivityAndDissipation) {
    const double a = 0.63 / 8;
    const double ag = 2 * a;
    const double root_pi = std::sqrt(pi);
    EXPECT_NEAR(dry.viscosity(a),
                0.8 * 2.5 * a * a * 0.01 * 2 * 1.9 / root_pi +
                    a * 2.5 * 0.01 * root_pi / (6 * 2.1) * (1 + 0.4 * 1.9 * 1.7 * ag),
                1e-15);
    const double h = 0.95;
    EXPECT_NEAR(dry.conductivity(a),
                15 * 0.01 * 2.5 * a * root_pi / (4 * (41 - 33 * h)) *
                    (1 + 2.4 * h * h * (4 * h - 3) * ag + 16 / (15 * pi) * (41 - 33 * h) * h * ag),
                1e-15);
    EXPECT_NEAR(dry.dissipation(a), 12 * (1 - 0.81) * 2 * 2.5 * a * a / (0.01 * root_pi), 1e-12);
    const Granular elastic{2.5, 0.01, 1, 0.63, 0};
    EXPECT_EQ(elastic.dissipation(a), 0);
}

// Without drag and expansion Q = G Theta; with drag alone sqrt(Theta) = Q/(3 K).
TEST(Granular, TemperatureBalancesProductionAndDissipation) {
    const double a = 0.2;
    const double shear = 50;
    const double q = 2 * dry.viscosity(a) * shear;
    EXPECT_NEAR(dry.balance(a, shear, 0, 1e9), q / dry.dissipation(a), 1e-12 * q / dry.dissipation(a));
    const Granular wet{2.5, 0.01, 0.9, 0.63, 1e7};
    const double slow = q / (3 * 1e7 * a);
    EXPECT_NEAR(wet.balance(a, shear, 0, 1e9), slow * slow, 1e-6 * slow * slow);
    // The general root satisfies its equation, expanding or shrinking.
    for (const double expansion : {-5.0, 3.0}) {
        const Granular damp{2.5, 0.01, 0.9, 0.63, 3};
        const double theta = damp.balance(a, shear, expansion, 1e9);
        const double made = 2 * damp.viscosity(a) * (shear - expansion * expansion / 3) * std::sqrt(theta);
        const double lost = damp.dissipation(a) * std::pow(theta, 1.5) + (damp.pressure(a) * expansion + 9 * a) * theta;
        EXPECT_NEAR(made, lost, 1e-12 * made) << expansion;
    }
    EXPECT_EQ(dry.balance(a, 0, 0, 1e9), 0);
}

// Haff's law: a homogeneous gas cools as Theta_0/(1 + t/t_0)^2, 1/t_0 = G sqrt(Theta_0)/(3 xi a)
// (Haff 1983, doi 10.1017/S0022112083003419); first order in the step, extrapolated.
TEST(GranularTemperature, CoolsByHaffsLaw) {
    const int n = 4;
    const auto grid = cube(n);
    const double fraction = 0.1;
    SolidsVolume solids(grid, everywhere, fraction / (n * n * n), 0.2);
    solids.start(lattice(n));
    const Straining still(grid);
    const double start = 100;
    const double rate = dry.dissipation(fraction) * 10 / (3 * 2.5 * fraction);
    const double end = 2 / rate;
    const auto cooled = [&](int steps) {
        TransportedTemperature temperature(grid, dry, {0, 1e12, 1e-6});
        temperature.set(start);
        for (int s = 0; s < steps; ++s) temperature.advance(solids, still, end / steps);
        return temperature.values()(2, 3, 1);
    };
    const double exact = start / 9;
    const double coarse = cooled(100);
    const double fine = cooled(200);
    EXPECT_NEAR(fine, exact, 0.01 * exact);
    EXPECT_NEAR(2 * fine - coarse, exact, 1e-4 * exact);
    EXPECT_NEAR((coarse - exact) / (fine - exact), 2, 0.05);
}

// Steady uniform shear: transport ends where the algebraic balance is; an elastic gas without drag would heat forever.
TEST(GranularTemperature, TransportedReachesTheBalanceInSteadyShear) {
    const int n = 4;
    const auto grid = cube(n);
    const double fraction = 0.15;
    SolidsVolume solids(grid, everywhere, fraction / (n * n * n), 0.2);
    solids.start(lattice(n));
    Straining sheared(grid);
    for (double& s : sheared.shear.values()) s = 0.5 * 30 * 30;  // dv_y/dz = 30
    AlgebraicTemperature algebraic(grid, dry, {0, 1e12, 1e-6});
    algebraic.advance(solids, sheared, 1);
    const double balance = dry.balance(fraction, 450, 0, 1e12);
    EXPECT_NEAR(algebraic.values()(2, 2, 2), balance, 1e-9 * balance);
    TransportedTemperature transported(grid, dry, {1e-3, 1e12, 1e-6});
    for (int s = 0; s < 4000; ++s) transported.advance(solids, sheared, 1e-3);
    EXPECT_NEAR(transported.values()(2, 2, 2), balance, 1e-6 * balance);
}

// A cloud that moves as one body neither makes nor loses granular energy: a uniform Theta stays uniform although the
// volume fraction of every cell changes.
TEST(GranularTemperature, StaysUniformInAMovingCloud) {
    const auto grid = cube(8);
    const double v = 2e-4;
    SolidsVolume solids(grid, everywhere, v, 0.1);
    const stats::Stream random(3, 3);
    std::vector<Vec3> positions;
    for (std::uint64_t p = 0; p < 800; ++p)
        positions.push_back(
            {random.uniform(3 * p) - 0.5, random.uniform(3 * p + 1) - 0.5, random.uniform(3 * p + 2) - 0.5});
    solids.start(positions);
    Granular elastic = dry;
    elastic.restitution = 1;
    TransportedTemperature temperature(grid, elastic, {0, 1e12, 1e-9});
    temperature.set(7);
    const Straining still(grid);
    temperature.advance(solids, still, 1e-9);
    for (int s = 0; s < 10; ++s) {
        auto after = positions;
        for (Vec3& x : after) {
            const Vec3 step{0.011, -0.017, 0.023};
            for (std::size_t d = 0; d < 3; ++d) {
                x[d] += step[d];
                x[d] -= std::floor(x[d] + 0.5);
            }
        }
        solids.place(after);
        solids.carry(1e-3);
        positions = after;
        temperature.advance(solids, still, 1e-3);
    }
    for (int k = 1; k <= 8; ++k)
        for (int j = 1; j <= 8; ++j)
            for (int i = 1; i <= 8; ++i) EXPECT_NEAR(temperature.values()(i, j, k), 7, 1e-9);
}

// Strain of a linear velocity field, wherever there are particles.
TEST(Straining, MeasuresALinearField) {
    const int n = 6;
    const auto grid = cube(n);
    SolidsVolume solids(grid, {}, 0.1 / (n * n * n), 0);
    const auto positions = lattice(n);
    std::vector<Vec3> velocity;
    for (const Vec3& x : positions) velocity.push_back({2 * x[0] + 3 * x[1], -x[1], 4 * x[2]});
    solids.start(positions);
    std::array<flow::Field, 3> mean{flow::Field(grid), flow::Field(grid), flow::Field(grid)};
    solids.mean(velocity, mean);
    Straining straining(grid);
    straining.measure(grid, solids.fraction(), mean, 1e-6);
    EXPECT_NEAR(straining.expansion(3, 4, 2), 5, 1e-10);
    EXPECT_NEAR(straining.shear(3, 4, 2), 4 + 1 + 16 + 2 * 1.5 * 1.5, 1e-10);
}

// Loading along K_l s, unloading along K_u from the largest force, zero at s0 = s_max (1 - e^2), reloading back.
TEST(HystereticSpring, LoadsAndUnloadsAlongTheTwoLines) {
    const HystereticSpring spring{100, 0.6, 0.3};
    SpringMemory memory;
    for (int s = 1; s <= 100; ++s) EXPECT_NEAR(spring.push(1e-5 * s, memory), 1e-3 * s, 1e-15);
    const double largest = 1e-3;
    EXPECT_NEAR(spring.push(0.9e-3, memory), 0.1 - 100 / 0.36 * 1e-4, 1e-12);
    const double left = largest * (1 - 0.36);
    EXPECT_NEAR(spring.push(left, memory), 1e-3 * 100 * left, 1e-12);  // the floor that lets the force end with s
    EXPECT_NEAR(spring.push(0.95e-3, memory), 1e-3 * 100 * left + 100 / 0.36 * (0.95e-3 - left), 1e-12);
    EXPECT_NEAR(spring.push(2e-3, memory), 0.2, 1e-12);  // back on the virgin line
}

TEST(HystereticSpring, FrictionGrowsWithSlipUpToCoulombsLimit) {
    const HystereticSpring spring{100, 0.8, 0.3};
    SpringMemory memory;
    spring.push(1e-3, memory);
    const Vec3 n{0, 0, 1};
    EXPECT_NEAR(spring.drag(n, {1e-5, 0, 0}, memory)[0], -1e-3, 1e-15);
    EXPECT_NEAR(spring.drag(n, {1, 0, 0}, memory)[0], -0.3 * 0.1, 1e-15);
    EXPECT_NEAR(spring.drag(n, {-1e-5, 0, 0}, memory)[0], -0.03 + 1e-3, 1e-15);  // sliding kept xi on the cone
    // Turned with the contact plane: the same length in the new plane.
    const Vec3 turned = spring.drag({1, 0, 0}, {}, memory);
    EXPECT_NEAR(turned[0], 0, 1e-18);
}

// A mass on the spring: it leaves with e times its speed after (pi/2)(sqrt(m/K_l) + sqrt(m/K_u)).
TEST(HystereticSpring, HasTheClosedFormsOfACollision) {
    for (const double e : {0.3, 0.6, 0.9}) {
        const HystereticSpring spring{50, e, 0};
        const double mass = 2;
        const double duration =
            0.5 * std::numbers::pi * (std::sqrt(mass / spring.stiffness) + std::sqrt(mass / spring.unloading()));
        const double h = duration / 20000;
        SpringMemory memory;
        double x = 0;
        double v = 1;
        int steps = 0;
        do {
            const double middle = x + 0.5 * h * v;
            if (middle > 0) v -= h / mass * spring.push(middle, memory);
            x = middle + 0.5 * h * v;
            ++steps;
        } while (memory.force > 2e-3 * 50 * memory.overlap || v > 0);
        EXPECT_NEAR(v, -e, 2e-3) << e;
        EXPECT_NEAR(steps * h, duration, 2e-3 * duration) << e;
    }
}

}  // namespace grainsweep::tests::coupling_granular_test
