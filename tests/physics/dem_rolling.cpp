// Rolling resistance (solver/dem/laws/rolling.hpp) against LIGGGHTS 3.8, against closed forms, and in both engines.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>
#include <vector>

namespace grainsweep::tests::dem_rolling_test {

using dem::Method;
using dem::Vec3;

constexpr double radius = 1e-3;
constexpr double gravity = 9.81;

dem::Setup soft_spheres(double rolling_friction, double time_step) {
    dem::Setup s;
    s.domain = {{-0.05, -0.05, -0.02}, {0.05, 0.05, 0.05}, {}};
    s.material.youngs_modulus = 5e6;
    s.material.poisson_ratio = 0.3;
    s.material.density = 2500;
    s.material.restitution = 0.6;
    s.material.friction = 0.5;
    s.material.rolling_friction = rolling_friction;
    s.material.rolling_damping = 0.3;
    s.gravity = {};
    s.time_step = time_step;
    return s;
}

constexpr auto exact = Method::Precision::double_precision;
constexpr auto mixed = Method::Precision::mixed;

/// Largest difference to a recorded trajectory: positions over the diameter, speeds and R w over the largest speed.
double deviation(const std::string& name, dem::Setup setup, Method::Precision precision) {
    setup.material.tangential_limit = dem::TangentialLimit::spring;
    const auto table = tests::read_table(tests::reference("rolling/" + name + ".csv"));
    double fastest = 0;
    for (const auto& sphere : setup.spheres)
        fastest =
            std::max({fastest, geometry::norm(sphere.velocity), radius * geometry::norm(sphere.angular_velocity)});
    const auto engine = dem::make_engine(setup, method(precision));
    dem::State state;
    double worst = 0;
    for (std::size_t r = 0; r < table.rows; ++r) {
        engine->run(static_cast<std::int64_t>(table.at("step", r)) - engine->work().steps);
        engine->state(state);
        const auto i = static_cast<std::size_t>(table.at("id", r)) - 1;
        const auto differs = [&](const Vec3& mine, const std::array<const char*, 3>& columns, double scale) {
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(mine[k] - table.at(columns[k], r)) * scale);
        };
        differs(state.position[i], {"x", "y", "z"}, 1 / (2 * radius));
        differs(state.velocity[i], {"vx", "vy", "vz"}, 1 / fastest);
        differs(state.angular_velocity[i], {"omegax", "omegay", "omegaz"}, radius / fastest);
    }
    EXPECT_EQ(engine->fault(), "");
    EXPECT_GT(table.rows, 15U);
    return worst;
}

/// A sphere on a plane through the origin, at the overlap that carries its weight.
struct OnPlane {
    dem::Setup setup;
    double mass, overlap, arm;
};

OnPlane on_plane(double rolling_friction, double slope) {
    OnPlane p{soft_spheres(rolling_friction, 5e-7), 0, 0, 0};
    p.setup.material.friction = 0.8;
    p.mass = dem::sphere_mass(radius, p.setup.material.density);
    p.setup.gravity = {gravity * std::sin(slope), 0, -gravity * std::cos(slope)};
    const double stiffness = 4.0 / 3 * dem::effective_modulus(p.setup.material) * std::sqrt(radius);
    p.overlap = std::pow(p.mass * gravity * std::cos(slope) / stiffness, 2.0 / 3);
    p.arm = radius - p.overlap / 2;
    p.setup.spheres = {{{0, 0, radius - p.overlap}, {}, {}, radius, true}};
    p.setup.walls = {dem::Plane{}};
    return p;
}

/// Acceleration between two times, m/s2.
double acceleration(const dem::Setup& setup, Method::Precision precision, std::int64_t first, std::int64_t last) {
    const auto engine = dem::make_engine(setup, method(precision));
    engine->run(first);
    const double before = tests::state_of(*engine).velocity[0][0];
    engine->run(last - first);
    EXPECT_EQ(engine->fault(), "");
    return (tests::state_of(*engine).velocity[0][0] - before) / (setup.time_step * static_cast<double>(last - first));
}

// Same formulas and time step: a pair differs by rounding, which a contact that yields does not multiply; in mixed
// precision the forces' roundings of 6e-8 add up over thousands of steps. At a plane LIGGGHTS turns a spring by (R -
// d/2)/(R - d) times the angle: overlaps reach 2 % of R in the impact, 0.1 % in rolling, of which the moment below its
// limit feels half.
TEST(DemRolling, EqualsLiggghts) {
    auto pair = soft_spheres(0.1, 1e-7);
    pair.spheres = {{{0, 0, 0}, {}, {0, 30, 5}, 1e-3, true},
                    {{1.72e-3, 1e-4, 0}, {-0.1, 0, 0}, {4, -20, 3}, 7e-4, true}};
    EXPECT_LT(deviation("pair_spin", pair, exact), 1e-12);
    EXPECT_LT(deviation("pair_spin", pair, mixed), 1e-5);

    auto yielding = soft_spheres(0.01, 2e-7);
    yielding.spheres = {{{0, 0, 0}, {0.02, 0, 0}, {0, 300, 50}, 1e-3, true},
                        {{2.005e-3, 1e-4, 3e-4}, {-0.1, 0, 0.05}, {40, 200, 30}, 1e-3, true}};
    EXPECT_LT(deviation("pair_yield", yielding, exact), 1e-12);
    EXPECT_LT(deviation("pair_yield", yielding, mixed), 1e-5);

    auto rolling = soft_spheres(0.05, 2e-6);
    rolling.gravity = {0, 0, -9.81};
    rolling.walls = {dem::Plane{}};
    rolling.spheres = {{{0, 0, 1e-3 + 1e-9}, {0.03, 0, 0}, {0, 30, 0}, 1e-3, true}};
    EXPECT_LT(deviation("plane_roll", rolling, exact), 1e-3);
    EXPECT_LT(deviation("plane_roll", rolling, mixed), 1e-3);

    auto impact = soft_spheres(0.1, 2e-7);
    impact.walls = {dem::Plane{}};
    impact.spheres = {{{0, 0, 1.001e-3}, {0.1, 0.02, -0.2}, {10, -40, 20}, 1e-3, true}};
    EXPECT_LT(deviation("plane_impact", impact, exact), 2e-3);
    EXPECT_LT(deviation("plane_impact", impact, mixed), 2e-3);
    for (auto* setup : {&rolling, &impact}) setup->material.rolling_law = dem::RollingLaw::epsd_liggghts;
    EXPECT_LT(deviation("plane_roll", rolling, exact), 1e-11);
    EXPECT_LT(deviation("plane_roll", rolling, mixed), 1e-6);
    EXPECT_LT(deviation("plane_impact", impact, exact), 1e-11);
    EXPECT_LT(deviation("plane_impact", impact, mixed), 1e-6);
}

/// Largest difference between both precisions at 200 moments 100 steps apart: velocities and R w over the largest
/// speed. `fed` spheres come half-way.
double difference(const dem::Setup& setup, std::span<const dem::Sphere> fed = {}) {
    const auto one = dem::make_engine(setup, method(exact));
    const auto other = dem::make_engine(setup, method(mixed));
    double fastest = 0, worst = 0;
    for (int k = 0; k < 200; ++k) {
        if (k == 100 && !fed.empty()) one->add(fed), other->add(fed);
        one->run(100), other->run(100);
        const auto a = tests::state_of(*one), b = tests::state_of(*other);
        using geometry::operator-;
        for (std::size_t i = 0; i < a.velocity.size(); ++i) {
            fastest = std::max(fastest, geometry::norm(a.velocity[i]));
            worst = std::max({worst, geometry::norm(a.velocity[i] - b.velocity[i]),
                              radius * geometry::norm(a.angular_velocity[i] - b.angular_velocity[i])});
        }
    }
    EXPECT_EQ(one->fault() + other->fault(), "");
    return worst / fastest;
}

// Two precisions, one trajectory: a sphere rolls down a slope, slowly over a plane, and on a belt that starts under it.
// Its moment and its friction are at their limits for a while and below them for another. Positions are resolved to
// 3e-8 and 1.4e-6 diameters in these domains; an overlap at rest is 5e-4.
TEST(DemRolling, IsTheSameInBothPrecisions) {
    enum class Course { slope, slow, belt };
    for (const auto limit : {dem::TangentialLimit::sum, dem::TangentialLimit::spring})
        for (const auto law : {dem::RollingLaw::epsd, dem::RollingLaw::epsd_liggghts, dem::RollingLaw::cdt})
            for (const auto course : {Course::slope, Course::slow, Course::belt})
                for (const double half : {0.05, 3.0}) {
                    auto p = on_plane(0.05, course == Course::slope ? 0.2 : 0);
                    p.setup.material.tangential_limit = limit;
                    p.setup.material.rolling_law = law;
                    p.setup.time_step = 2e-6;
                    p.setup.domain = {{-half, -half, -half}, {half, half, half}, {}};
                    if (course == Course::belt)
                        p.setup.walls[0].motions = {geometry::Translation{.velocity = {0.2, 0.05, 0}}};
                    else
                        p.setup.spheres[0].velocity = {course == Course::slow ? 0.002 : 0.02, 0, 0};
                    EXPECT_LT(difference(p.setup), 3e-6) << static_cast<int>(limit) << static_cast<int>(law) << " "
                                                         << static_cast<int>(course) << " " << half;
                }
}

// Without rolling resistance, of a stiff sphere, and on the curved wall of a drum.
TEST(DemRolling, IsTheSameInBothPrecisionsOnOtherWalls) {
    for (const double half : {0.05, 3.0}) {
        auto plain = on_plane(0, 0.02);
        plain.setup.time_step = 2e-6;
        auto stiff = on_plane(0.05, 0.02);
        stiff.setup.material.youngs_modulus = 1e9;
        stiff.setup.time_step = 2e-7;
        stiff.setup.spheres[0].position[2] = radius;
        auto drum = on_plane(0.05, 0);
        drum.setup.time_step = 2e-6;
        drum.setup.walls = {dem::Wall(dem::Cylinder{.point = {0, 0, 0.02}, .axis = {0, 1, 0}, .radius = 0.02},
                                      {dem::Rotation{.point = {0, 0, 0.02}, .axis = {0, 1, 0}, .speed = 3}})};
        for (auto* p : {&plain, &stiff, &drum}) {
            p->setup.domain = {{-half, -half, -half}, {half, half, half}, {}};
            p->setup.spheres[0].velocity = {0.005, 0.001, 0};
            EXPECT_LT(difference(p->setup), 1e-6)
                << half << " " << p->setup.walls[0].motions.size() << " " << p->setup.material.youngs_modulus;
        }
    }
}

// Among many, of one size and of two, and where more come: 400 spheres roll slowly over a plane, apart from each other,
// in a domain of 3000 diameters. Single precision makes 0.8 of a radius another by 1e-8, a hundred-thousandth of the
// overlap.
TEST(DemRolling, IsTheSameInBothPrecisionsAmongManyAndWithAFeed) {
    constexpr int per_side = 20;
    for (const double smaller : {1.0, 0.75, 0.8})
        for (const bool feeds : {false, true}) {
            auto p = on_plane(0.05, 0.01);
            p.setup.time_step = 2e-6;
            p.setup.domain = {{-3, -3, -3}, {3, 3, 3}, {}};
            const auto first = p.setup.spheres.front();
            p.setup.spheres.clear();
            for (int i = 0; i < per_side; ++i)
                for (int j = 0; j < per_side; ++j) {
                    auto sphere = first;
                    sphere.radius *= (i + j) % 2 == 0 ? 1 : smaller;
                    sphere.position = {4e-3 * i, 4e-3 * j, sphere.radius - p.overlap};
                    sphere.velocity = {0.002 + 1e-4 * i, 1e-4 * j, 0};
                    p.setup.spheres.push_back(sphere);
                }
            std::vector<dem::Sphere> fed;
            if (feeds) {
                p.setup.to_come = {{.smallest = smaller * radius, .largest = radius}};
                fed.assign(p.setup.spheres.begin(), p.setup.spheres.begin() + 20);
                for (auto& sphere : fed) sphere.position[0] -= 0.05;
            }
            EXPECT_LT(difference(p.setup, fed), 3e-6) << smaller << " " << feeds;
        }
}

// Both laws: the moment of a rolling sphere is mu_r R F_n.
// m dv/dt = -f,  I dw/dt = f a - mu_r R m g,  v = a w  with the arm a = R - d/2 of this law:
//     dv/dt = -mu_r g (R/a)/(1 + 2/5 (R/a)^2)        that is -5/7 mu_r g for a hard sphere.
TEST(DemRolling, DeceleratesARollingSphere) {
    for (const auto& [mu_r, law] : {std::pair{0.02, dem::RollingLaw::epsd}, std::pair{0.1, dem::RollingLaw::epsd},
                                    std::pair{0.02, dem::RollingLaw::cdt}, std::pair{0.1, dem::RollingLaw::cdt}}) {
        auto p = on_plane(mu_r, 0);
        p.setup.material.rolling_law = law;
        p.setup.spheres[0].velocity = {0.05, 0, 0};
        p.setup.spheres[0].angular_velocity = {0, 0.05 / p.arm, 0};
        const double ratio = radius / p.arm;
        const double expected = -mu_r * gravity * ratio / (1 + 0.4 * ratio * ratio);
        EXPECT_NEAR(expected, -5.0 / 7 * mu_r * gravity, 2e-4 * mu_r * gravity);
        // The wind-up of the spring rings in the tangential spring for a while.
        EXPECT_NEAR(acceleration(p.setup, exact, 20000, 60000) / expected, 1, 1e-4) << mu_r;
        // A step changes the spin by some 1e-5 of itself: single precision would round that alike each time, by up to
        // 3 %, if it did not carry on what it drops.
        EXPECT_NEAR(acceleration(p.setup, mixed, 20000, 60000) / expected, 1, 1e-4) << mu_r;
    }
}

// On a slope it rests while tan(angle) < mu_r, and beyond rolls with
//     dv/dt = g (sin(angle) - mu_r cos(angle) R/a)/(1 + 2/5 (R/a)^2).
TEST(DemRolling, StandsOnASlopeBelowItsAngle) {
    constexpr double mu_r = 0.2;
    for (const auto precision : {exact, mixed}) {
        auto below = on_plane(mu_r, std::atan(0.95 * mu_r));
        // The spring gives by d/(2.25 mu_r), and more as it swings beyond: by 7.5 d with a dashpot that is not limited,
        // by 10.3 d with one that has the twentieth of the limit which the slope leaves.
        for (const auto& [limit, farthest] :
             {std::pair{dem::TangentialLimit::spring, 10.0}, {dem::TangentialLimit::sum, 12.0}}) {
            below.setup.material.tangential_limit = limit;
            const auto engine = dem::make_engine(below.setup, method(precision));
            engine->run(100000);  // 50 ms, a hundred periods of rocking
            const auto state = tests::state_of(*engine);
            EXPECT_LT(std::abs(state.velocity[0][0]), 1e-6);
            EXPECT_LT(state.position[0][0], farthest * below.overlap);
            EXPECT_GT(state.position[0][0], 2 * below.overlap);
        }

        const double slope = std::atan(1.2 * mu_r);
        const auto above = on_plane(mu_r, slope);
        const double ratio = radius / above.arm;
        const double expected =
            gravity * (std::sin(slope) - mu_r * std::cos(slope) * ratio) / (1 + 0.4 * ratio * ratio);
        EXPECT_NEAR(acceleration(above.setup, precision, 20000, 60000) / expected, 1, 1e-3);
    }
}

// What has stopped rocks about its contact: I_r = 7/5 m R^2, k_r = 2.25 m g/d mu_r^2 R^2, decaying with the damping
// ratio asked for. The tangential spring in series, and I about the contact point at R - d/2 instead of R, are worth
// k_r/(k_t a^2) + 3 d/R, below 1 % here.
TEST(DemRolling, RocksToRestWithTheDampingRatioAskedFor) {
    constexpr double mu_r = 0.05;
    for (const double damping : {0.05, 0.3}) {
        auto p = on_plane(mu_r, 0);
        p.setup.material.rolling_damping = damping;
        const double stiffness = 2.25 * p.mass * gravity / p.overlap * mu_r * mu_r * radius * radius;
        const double frequency = std::sqrt(stiffness / (1.4 * p.mass * radius * radius));
        const double damped = frequency * std::sqrt(1 - damping * damping);
        const double start = 0.01 * p.overlap * frequency / radius;  // rad/s, far below the limit
        p.setup.spheres[0].angular_velocity = {0, start, 0};
        p.setup.spheres[0].velocity = {p.arm * start, 0, 0};
        const auto half_periods = std::llround(2 * std::numbers::pi / damped / p.setup.time_step);
        const auto engine = dem::make_engine(p.setup, {});
        engine->run(half_periods);
        const double after = static_cast<double>(half_periods) * p.setup.time_step;
        const double expected =
            std::exp(-damping * frequency * after) *
            (std::cos(damped * after) - damping / std::sqrt(1 - damping * damping) * std::sin(damped * after));
        EXPECT_NEAR(tests::state_of(*engine).angular_velocity[0][1] / start, expected, 0.01) << damping;
    }
}

// Among many, of two sizes and between planes: less rotation is left.
TEST(DemRolling, AGasWithRollingResistanceLosesSpinSooner) {
    double spin[2] = {};
    for (const int k : {0, 1}) {
        auto gas = tests::boxed_gas(200, 0.5, 2, 21);
        gas.material.rolling_friction = k == 0 ? 0 : 0.3;
        const auto engine = dem::make_engine(gas, {});
        engine->run(4000);
        ASSERT_EQ(engine->fault(), "");
        for (const auto& w : tests::state_of(*engine).angular_velocity) spin[k] += geometry::dot(w, w);
    }
    EXPECT_LT(spin[1], 0.9 * spin[0]);
}

// Constant torque: it rolls down a slope steeper than mu_r as with a spring, and below it has no threshold: it stays,
// but for its chatter about w = 0, within one step's change of spin.
TEST(DemRolling, AConstantTorqueHoldsASphereOnASlopeBelowItsAngle) {
    constexpr double mu_r = 0.2;
    for (const auto precision : {exact, mixed}) {
        auto below = on_plane(mu_r, std::atan(0.95 * mu_r));
        below.setup.material.rolling_law = dem::RollingLaw::cdt;
        const auto engine = dem::make_engine(below.setup, method(precision));
        engine->run(100000);
        const auto state = tests::state_of(*engine);
        const double chatter = mu_r * below.mass * gravity * radius * below.setup.time_step /
                               (0.4 * below.mass * radius * radius);  // rad/s a step
        EXPECT_LT(std::abs(state.angular_velocity[0][1]), 2 * chatter);
        EXPECT_LT(state.position[0][0], 5 * below.overlap);

        const double slope = std::atan(1.2 * mu_r);
        auto above = on_plane(mu_r, slope);
        above.setup.material.rolling_law = dem::RollingLaw::cdt;
        const double ratio = radius / above.arm;
        const double expected =
            gravity * (std::sin(slope) - mu_r * std::cos(slope) * ratio) / (1 + 0.4 * ratio * ratio);
        EXPECT_NEAR(acceleration(above.setup, precision, 20000, 60000) / expected, 1, 1e-3);
    }
}

// The torque follows the whole relative rotation, of which the part along n is then taken out: a twisting pair is
// resisted less in rolling, and not at all in twisting.
TEST(DemRolling, AConstantTorqueIsDirectedByTheWholeRotation) {
    auto s = soft_spheres(0.3, 1e-7);
    s.material.rolling_law = dem::RollingLaw::cdt;
    s.material.friction = 1e-9;
    s.spheres = {{{0, 0, 0}, {}, {30, 40, 0}, 1e-3, true}, {{1.99e-3, 0, 0}, {}, {}, 1e-3, true}};
    const double overlap = 1e-5, effective = 5e-4;
    const double elastic = 4.0 / 3 * dem::effective_modulus(s.material) * std::sqrt(effective * overlap) * overlap;
    std::vector<dem::ContactForce> contacts;
    for (const auto precision : {exact, mixed}) {
        const auto engine = dem::make_engine(s, method(precision));
        engine->contacts(contacts);
        ASSERT_EQ(contacts.size(), 1U);
        const double sign = contacts[0].first == 0 ? -1 : 1;
        const double tolerance = precision == exact ? 1e-12 : 1e-5;  // the overlap is 2e5 units of position
        EXPECT_NEAR(sign * contacts[0].rolling_moment[1] / (0.3 * elastic * effective), 0.8, tolerance);
        EXPECT_NEAR(contacts[0].rolling_moment[0] / (0.3 * elastic * effective), 0, tolerance);
    }
}

}  // namespace grainsweep::tests::dem_rolling_test
