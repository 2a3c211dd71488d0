// Powder at rest that is not advanced: which particles rest, which are advanced again, and that nothing is lost. The
// plain path beside it is the same engine without a rest speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/granular_scenes.hpp"

namespace grainsweep::tests::fast_resting_test {

using namespace geometry;
using dem::ContactForce;
using dem::Method;
using dem::fast::make_mixed_engine;

constexpr double d = 1e-3;
constexpr double slow = 2e-3;  // m/s; a sphere falls through its radius in seven times this, times seven

std::vector<Method::Path> paths() {
    std::vector<Method::Path> all;
    for (const auto p : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512})
        if (dem::fast::supports(p)) all.push_back(p);
    return all;
}

/// Four layers on a frozen floor inside planes, each sphere in a hollow of the layer below; not quite regular.
dem::Setup pile(bool cohesive = false, double spread = 0) {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.friction = 0.5;
    s.material.cohesion = cohesive ? 1e5 : 0;
    s.time_step = 2e-6;
    s.domain = {{-2 * d, -2 * d, -2 * d}, {8 * d, 8 * d, 20 * d}, {}};
    for (int layer = 0; layer < 5; ++layer) {
        const int side = 6 - layer % 2;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double shift = layer % 2 == 0 ? 0 : 0.55;
                const double radius = 0.5 * d * (1 + spread * std::sin(7.0 * i + 3.0 * j + layer));
                s.spheres.push_back(
                    {{(1.1 * i + shift) * d, (1.1 * j + shift) * d, 0.64 * layer * d}, {}, {}, radius, layer > 0});
            }
    }
    for (const double side : {1.0, -1.0})
        for (std::size_t a = 0; a < 2; ++a) {
            dem::Plane plane;
            plane.point = {side > 0 ? -0.5 * d : 6 * d, side > 0 ? -0.5 * d : 6 * d, 0};
            plane.normal = {};
            plane.normal[a] = side;
            s.walls.emplace_back(plane);
        }
    return s;
}

std::vector<ContactForce> contacts_of(const dem::Engine& engine) {
    std::vector<ContactForce> all;
    engine.contacts(all);
    for (ContactForce& c : all)  // seen from the lower id; walls stay second
        if (c.second >= 0 && c.second < c.first) {
            std::swap(c.first, c.second);
            c.normal = -1.0 * c.normal;
            c.tangential_force = -1.0 * c.tangential_force;
            c.rolling_moment = -1.0 * c.rolling_moment;
        }
    std::ranges::sort(all, {}, [](const ContactForce& c) { return std::pair(c.first, c.second); });
    return all;
}

dem::State state_of(const dem::Engine& engine) {
    dem::State s;
    engine.state(s);
    return s;
}

void expect_same_bits(const dem::Engine& a, const dem::Engine& b) {
    const dem::State s = state_of(a), t = state_of(b);
    EXPECT_EQ(s.id, t.id);
    EXPECT_EQ(s.position, t.position);
    EXPECT_EQ(s.velocity, t.velocity);
    EXPECT_EQ(s.angular_velocity, t.angular_velocity);
    EXPECT_EQ(a.largest_overlap(), b.largest_overlap());
    const auto u = contacts_of(a), v = contacts_of(b);
    ASSERT_EQ(u.size(), v.size());
    for (std::size_t k = 0; k < u.size(); ++k) {
        EXPECT_EQ(u[k].normal_force, v[k].normal_force);
        EXPECT_EQ(u[k].tangential_force, v[k].tangential_force);
    }
}

double weight(const dem::Setup& s, double radius) {
    return dem::sphere_mass(radius, s.material.density) * norm(s.gravity);
}

/// Share of the mobile particles that rest during the next step.
double at_rest(dem::Engine& engine) {
    const dem::Work before = engine.work();
    engine.run(1);
    const dem::Work after = engine.work();
    return (after.resting_steps - before.resting_steps) / (after.particle_steps - before.particle_steps);
}

/// Every mobile sphere's contacts carry its weight, within the force at which it would move again.
void expect_weights_carried(const dem::Setup& setup, const dem::Engine& engine) {
    std::vector<Vec3> force(setup.spheres.size());
    for (const ContactForce& c : contacts_of(engine)) {
        const Vec3 f = c.normal_force * c.normal + c.tangential_force;
        force[static_cast<std::size_t>(c.first)] += f;
        if (c.second >= 0) force[static_cast<std::size_t>(c.second)] -= f;
    }
    for (std::size_t i = 0; i < force.size(); ++i) {
        if (!setup.spheres[i].mobile) continue;
        const double own = weight(setup, setup.spheres[i].radius);
        EXPECT_LT(norm(force[i] + Vec3{0, 0, -own}), 0.55 * own) << i;
    }
}

constexpr std::int64_t settling = 60000;

// A rest speed that a fall reaches only after thousands of steps.
TEST(FastResting, APileInTheAirIsNoneAtRest) {
    dem::Setup setup = pile();
    constexpr double high = 10 * d, fast = 0.2;
    for (auto& sphere : setup.spheres)
        if (sphere.mobile) sphere.position[2] += high;
    const auto free = make_mixed_engine(setup, paths().back(), 0);
    const auto engine = make_mixed_engine(setup, paths().back(), 0, fast);
    const auto falling = static_cast<std::int64_t>(0.9 * std::sqrt(2 * high / norm(setup.gravity)) / setup.time_step);
    for (const auto& one : {free.get(), engine.get()}) one->run(falling);
    EXPECT_EQ(state_of(*engine).position, state_of(*free).position);
    EXPECT_EQ(at_rest(*engine), 0);
    engine->run(4 * falling);
    EXPECT_EQ(engine->fault(), "");
    for (const Vec3& x : state_of(*engine).position) EXPECT_LT(x[2], 0.5 * high);
}

// Forces and memories of parked contacts are in units of a part of the step.
TEST(FastResting, APileWhoseStepsAreHalvedCarriesItsWeight) {
    dem::Setup setup = pile();
    setup.gravity = {0, 0, -9810};
    setup.material.restitution = 0.2;
    setup.time_step = 1.2e-5;
    setup.step_share = 0.8;
    const auto engine = make_mixed_engine(setup, paths().back(), 0, 0.02);
    engine->run(settling / 4);
    ASSERT_EQ(engine->fault(), "");
    EXPECT_GE(engine->work().most_parts, 2);
    EXPECT_GT(at_rest(*engine), 0.9);
    expect_weights_carried(setup, *engine);
}

TEST(FastResting, APileComesToRestAndCarriesItsWeight) {
    for (const auto path : paths())
        for (const bool cohesive : {false, true})
            for (const double spread : {0.0, 0.05}) {
                if (spread > 0 && path != paths().back()) continue;  // takes long
                const dem::Setup setup = pile(cohesive, spread);
                const auto engine = make_mixed_engine(setup, path, 0, slow);
                engine->run(spread == 0 ? settling : 3 * settling);  // unequal ones roll about longer
                ASSERT_EQ(engine->fault(), "");
                EXPECT_EQ(at_rest(*engine), 1);
                const double overlap = engine->largest_overlap();
                double deepest = 0;
                for (const ContactForce& c : contacts_of(*engine))
                    if (c.second >= 0) deepest = std::max(deepest, c.overlap);
                expect_weights_carried(setup, *engine);
                EXPECT_GT(overlap, 0);
                if (spread == 0) {
                    EXPECT_NEAR(overlap, deepest / d, 1e-6);
                }
                for (const Vec3& v : state_of(*engine).velocity) EXPECT_EQ(norm(v), 0);
            }
}

TEST(FastResting, HistoriesComeBackAsTheyWere) {
    for (const auto path : paths()) {
        for (const dem::Surface& floor : {dem::Surface{}, dem::Surface{.friction = 0.8, .cohesion = 4e4}}) {
            dem::Setup setup = pile(true);
            setup.frozen = floor;
            const auto engine = make_mixed_engine(setup, path, 0, slow);
            engine->run(settling);
            ASSERT_EQ(at_rest(*engine), 1);
            const auto before = contacts_of(*engine);
            engine->set_walls(setup.walls);  // all are advanced again, none is moved
            const auto after = contacts_of(*engine);
            ASSERT_EQ(before.size(), after.size());
            double friction = 0;
            for (std::size_t k = 0; k < before.size(); ++k) {
                if (before[k].second < 0) continue;  // new walls have no histories
                // Histories are single precision numbers, 6e-8 apart. Velocities pass through a full step and back: of
                // zero 1e-14 m/s may remain, on which dashpots act.
                const double allowed = 1e-9 * weight(setup, 0.5 * d);
                EXPECT_NEAR(before[k].normal_force, after[k].normal_force, allowed);
                EXPECT_LE(norm(before[k].tangential_force - after[k].tangential_force), allowed);
                friction = std::max(friction, norm(before[k].tangential_force) / std::abs(after[k].normal_force));
            }
            EXPECT_GT(friction, 0.1);
        }
    }
}

TEST(FastResting, AFallingSphereBouncesAsFromAPileThatIsAdvanced) {
    for (const auto path : paths()) {
        dem::Setup setup = pile();
        setup.spheres.push_back({{2.7 * d, 2.9 * d, 9 * d}, {}, {}, 0.5 * d, true});
        const auto resting = make_mixed_engine(setup, path, 0, slow), advanced = make_mixed_engine(setup, path);
        const auto last = setup.spheres.size() - 1;
        for (auto* engine : {resting.get(), advanced.get()}) engine->run(17000);
        EXPECT_GT(at_rest(*resting), 0.7);  // those the sphere comes near are advanced already
        advanced->run(1);
        const double impact = -state_of(*advanced).velocity[last][2];
        for (auto* engine : {resting.get(), advanced.get()}) engine->run(1000);  // 0.35 ms after it bounced
        const dem::State a = state_of(*resting), b = state_of(*advanced);
        EXPECT_GT(impact, 0.3);
        EXPECT_GT(b.velocity[last][2], 0.2 * impact);
        EXPECT_LT(norm(a.velocity[last] - b.velocity[last]), 0.01 * impact);
        EXPECT_LT(norm(a.position[last] - b.position[last]), 0.01 * d);
        EXPECT_LT(at_rest(*resting), 0.8);
        resting->run(settling);
        EXPECT_EQ(resting->fault(), "");
        EXPECT_GT(at_rest(*resting), 0.9);
    }
}

TEST(FastResting, ABridgeWithoutItsSupportFalls) {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.friction = 0.5;
    s.time_step = 2e-6;
    s.domain = {{-5 * d, -5 * d, -20 * d}, {5 * d, 5 * d, 5 * d}, {}};
    for (const double x : {-0.6, 0.6})
        for (const double y : {-0.6, 0.6}) s.spheres.push_back({{x * d, y * d, 0}, {}, {}, 0.5 * d, false});
    for (int k = 0; k < 3; ++k) s.spheres.push_back({{0, 0, (0.54 + 1.001 * k) * d}, {}, {}, 0.5 * d, true});
    s.walls = {};
    for (const auto path : paths()) {
        const auto resting = make_mixed_engine(s, path, 0, slow), advanced = make_mixed_engine(s, path);
        for (auto* engine : {resting.get(), advanced.get()}) engine->run(20000);
        ASSERT_EQ(at_rest(*resting), 1);
        advanced->run(1);
        const std::vector<std::int32_t> support{0, 1};
        for (auto* engine : {resting.get(), advanced.get()}) engine->remove(support), engine->run(5000);
        const dem::State a = state_of(*resting), b = state_of(*advanced);
        for (std::size_t i = 2; i < a.id.size(); ++i) {
            EXPECT_LT(b.position[i][2], s.spheres[i + 2].position[2] - 0.1 * d);
            // It is advanced up to 128 steps late, when the other falls at g t.
            const double late = 128 * s.time_step, time = 5000 * s.time_step;
            EXPECT_LT(norm(a.position[i] - b.position[i]), 2 * 9.81 * late * time);
        }
    }
}

TEST(FastResting, ACheckpointOfPowderAtRestContinuesBitForBit) {
    for (const auto path : paths()) {
        dem::Setup setup = pile(true);
        setup.spheres.push_back({{2.7 * d, 2.9 * d, 12 * d}, {}, {}, 0.5 * d, true});
        const auto whole = make_mixed_engine(setup, path, 0, slow), resumed = make_mixed_engine(setup, path, 0, slow);
        whole->run(17000);
        ASSERT_GT(at_rest(*whole), 0.5);
        std::vector<std::byte> bytes, again;
        whole->save(bytes);
        resumed->restore(bytes);
        resumed->save(again);
        EXPECT_EQ(bytes, again);
        expect_same_bits(*whole, *resumed);
        for (const int steps : {1, 50, 5000, 7000}) {
            whole->run(steps), resumed->run(steps);
            expect_same_bits(*whole, *resumed);
            EXPECT_EQ(whole->work().resting_steps, resumed->work().resting_steps);
        }
        EXPECT_THROW(make_mixed_engine(setup, path)->restore(bytes), std::invalid_argument);
    }
}

TEST(FastResting, WhereNoneIsSlowTheLawsAreThePlainOnes) {
    for (const auto path : paths())
        for (const double spread : {0.0, 0.1}) {
            const dem::Setup setup = tests::boxed_lattice(4, 3, spread, 3);
            const auto may_rest = make_mixed_engine(setup, path, 0, 1e-9), plain = make_mixed_engine(setup, path);
            may_rest->run(3000), plain->run(3000);
            EXPECT_EQ(may_rest->work().resting_steps, 0);
            EXPECT_EQ(may_rest->work().rebuilds, plain->work().rebuilds);
            expect_same_bits(*may_rest, *plain);
        }
}

TEST(FastResting, ShakenAndWeightlessPowderHasNoRestSpeed) {
    Method method;
    method.precision = Method::Precision::mixed;
    method.rest_speed = slow;
    dem::Setup shaken = pile(), weightless = pile(), bladed = pile();
    shaken.shaking = {{0, 0, 1e-5}, 100};
    weightless.gravity = {};
    bladed.walls = {Blade{.front = d, .thickness = d, .bottom = 0, .top = d, .speed = 0.01}};
    EXPECT_NO_THROW((void)dem::make_engine(pile(), method));
    for (const auto& setup : {shaken, weightless, bladed})
        EXPECT_THROW((void)dem::make_engine(setup, method), std::invalid_argument);
}

}  // namespace grainsweep::tests::fast_resting_test
