// Powder under load: the time step follows the network of contacts, or a fixed step that is too long is reported.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/geometry/vector.hpp"
#include "stats/random.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::loaded_beds_test {

using namespace geometry;
using dem::Vec3;
using Precision = dem::Method::Precision;

constexpr double side = 0.018, modulus = 5e6, radius = 0.0015, settling = 0.12;

/// Some 250 grains of 3 mm between a floor and a lid that a stress presses from 0.12 s on; periodic across.
dem::Setup pressed_bed(double stress, double restitution, double fraction) {
    dem::Setup setup;
    setup.domain = {{0, 0, -0.01}, {side, side, 0.08}, {true, true, false}};
    setup.material.density = 2500;
    setup.material.youngs_modulus = modulus;
    setup.material.restitution = restitution;
    setup.material.friction = 0.5;
    setup.time_step = fraction * dem::shortest_time(setup.material, 0.9 * radius, 1);
    setup.step_share = dem::step_share(fraction);
    const stats::Stream random(1, 7);
    std::uint64_t draw = 0;
    const auto jitter = [&] { return 2e-4 * (random.uniform(draw++) - 0.5); };
    for (int z = 0; z < 10; ++z)
        for (int x = 0; x < 5; ++x)
            for (int y = 0; y < 5; ++y) {
                dem::Sphere sphere;
                sphere.radius = radius * (0.9 + 0.2 * random.uniform(draw++));
                sphere.position = {0.0036 * (x + 0.5) + jitter(), 0.0036 * (y + 0.5) + jitter(),
                                   0.0018 + 0.0036 * z + jitter()};
                setup.spheres.push_back(sphere);
            }
    setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    const Press press{
        .along = {0, 0, -1}, .force = stress * side * side, .mass = 0.01, .fastest = 0.3, .start = settling};
    setup.walls.emplace_back(dem::Plane{{0, 0, 0.04}, {0, 0, -1}}, std::vector<Motion>{press});
    return setup;
}

double rms_speed(const dem::Engine& engine) {
    const dem::State state = state_of(engine);
    double sum = 0;
    for (const Vec3& v : state.velocity) sum += dot(v, v);
    return std::sqrt(sum / static_cast<double>(state.velocity.size()));
}

void run_for(dem::Engine& engine, const dem::Setup& setup, double seconds) {
    engine.run(std::llround(seconds / setup.time_step));
}

// Nothing moves but the grains, so they must come to rest. At a fixed step of this length they boil at 0.1 to 0.3 m/s.
TEST(LoadedBeds, RestUnderTheirLoadAtEverySetting) {
    for (const Precision precision : {Precision::mixed, Precision::double_precision})
        for (const double restitution : {0.2, 0.5})
            for (const double fraction : {0.2, 0.35}) {
                if (precision == Precision::double_precision && fraction == 0.2) continue;  // for the tests' time
                const dem::Setup setup = pressed_bed(60e3, restitution, fraction);
                const auto engine = dem::make_engine(setup, method(precision));
                run_for(*engine, setup, 0.45);
                SCOPED_TRACE(testing::Message() << restitution << " " << fraction << " " << engine->fault());
                ASSERT_EQ(engine->fault(), "");
                EXPECT_LT(rms_speed(*engine), 0.01);
                EXPECT_GE(engine->work().most_parts, 2);
            }
}

// The same step, but fixed: a fault that names the load, the place and a step that would do; at that step it rests.
TEST(LoadedBeds, AFixedStepBeyondTheLimitIsReported) {
    for (const Precision precision : {Precision::mixed, Precision::double_precision}) {
        dem::Setup setup = pressed_bed(20e3, 0.2, 0.2);
        setup.step_share = {};
        const auto engine = dem::make_engine(setup, method(precision));
        run_for(*engine, setup, 0.45);
        EXPECT_NE(engine->fault().find("longest stable step of the loaded contacts"), std::string::npos)
            << engine->fault();
        EXPECT_NE(engine->fault().find("would do"), std::string::npos);
        const std::size_t at = engine->fault().find("a step of ");
        ASSERT_NE(at, std::string::npos);
        setup.time_step = std::stod(engine->fault().substr(at + 10));
        const auto finer = dem::make_engine(setup, method(precision));
        run_for(*finer, setup, 0.3);
        EXPECT_EQ(finer->fault(), "");
    }
}

TEST(LoadedBeds, ALightBedKeepsTheBitsOfAFixedStep) {
    for (const Precision precision : {Precision::mixed, Precision::double_precision}) {
        dem::Setup setup = pressed_bed(50, 0.5, 0.2);
        const auto follows = dem::make_engine(setup, method(precision));
        setup.step_share = {};
        const auto fixed = dem::make_engine(setup, method(precision));
        run_for(*follows, setup, 0.25);
        run_for(*fixed, setup, 0.25);
        EXPECT_EQ(follows->work().most_parts, 1);
        EXPECT_EQ(state_of(*follows).position, state_of(*fixed).position);
    }
}

// The number of parts is state: no bit depends on threads, slices or a checkpoint while steps are halved and doubled.
TEST(LoadedBeds, PartsDependOnTheStepsOnly) {
    dem::Setup setup = pressed_bed(30e3, 0.3, 0.3);
    // Released: the load ends, and steps become whole again.
    std::get<Press>(setup.walls[1].motions.front()).end = 0.2;
    for (const Precision precision : {Precision::mixed, Precision::double_precision}) {
        const auto whole = dem::make_engine(setup, method(precision));
        const auto sliced = dem::make_engine(setup, method(precision, 2));
        const auto total = std::llround(0.3 / setup.time_step);
        whole->run(total);
        std::vector<std::byte> bytes;
        auto resumed = dem::make_engine(setup, method(precision));
        for (std::int64_t step = 0, k = 0; step < total; ++k) {
            const std::int64_t some = std::min<std::int64_t>(k % 3 == 0 ? 1 : 97, total - step);
            if (k % 5 == 0 && some == 1) do
                    sliced->run_part();
                while (!sliced->at_step());
            else
                sliced->run(some);
            step += some;
            resumed->run(some);
            if (k % 20 != 0) continue;
            resumed->save(bytes);
            resumed = dem::make_engine(setup, method(precision));
            resumed->restore(bytes);
        }
        EXPECT_GE(whole->work().most_parts, 2);
        EXPECT_EQ(whole->work().steps, total);
        for (const auto* other : {sliced.get(), resumed.get()}) {
            EXPECT_EQ(state_of(*whole).position, state_of(*other).position);
            EXPECT_EQ(state_of(*whole).velocity, state_of(*other).velocity);
            EXPECT_EQ(whole->work().particle_steps, other->work().particle_steps);
            EXPECT_EQ(whole->work().most_parts, other->work().most_parts);
        }
    }
}

// A change of parts loses and creates nothing: an elastic bed keeps its energy book, and loads of walls stay in SI.
TEST(LoadedBeds, AChangeOfPartsChangesNoForce) {
    dem::Setup setup = pressed_bed(30e3, 0.5, 0.2);
    const auto coarse = dem::make_engine(setup, method(Precision::mixed));
    run_for(*coarse, setup, 0.45);
    ASSERT_GE(coarse->work().most_parts, 2);
    dem::Setup finer = pressed_bed(30e3, 0.5, 0.05);
    const auto fine = dem::make_engine(finer, method(Precision::mixed));
    run_for(*fine, finer, 0.45);
    const double load = 30e3 * side * side;
    for (const auto* engine : {coarse.get(), fine.get()}) {
        double weight = 0;
        for (const auto& sphere : setup.spheres) weight += mass(setup, sphere.radius) * 9.81;
        EXPECT_NEAR(-engine->wall_load(1, {}).force[2], -load, 0.02 * load);
        EXPECT_NEAR(engine->wall_load(0, {}).force[2], -(load + weight), 0.02 * load);
    }
}

}  // namespace grainsweep::tests::loaded_beds_test
