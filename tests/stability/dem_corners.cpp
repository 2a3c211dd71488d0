// What is too much must be reported, never silently wrong: time steps beyond their limits, particles inserted into each
// other, impacts no contact law was made for, and nothing at all.
#include "solver/dem/engine.hpp"
#include "solver/dem/limits.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::dem_corners_test {

/// Runs and expects finite numbers and, without a fault, an energy that has not grown; `stored` is in contacts at the
/// start.
std::string verdict(const dem::Setup& setup, std::int64_t steps, double stored = 0) {
    const auto engine = dem::make_engine(setup, {});
    const double start = tests::kinetic_energy(setup, state_of(*engine));
    engine->run(steps);
    const auto state = state_of(*engine);
    EXPECT_TRUE(tests::finite(state)) << engine->fault();
    double fall = 0;
    for (const auto& s : setup.spheres)
        for (std::size_t k = 0; k < 3; ++k)
            fall += tests::mass(setup, s.radius) * std::abs(setup.gravity[k]) *
                    (setup.domain.high[k] - setup.domain.low[k]);
    if (engine->fault().empty()) {
        EXPECT_LE(tests::kinetic_energy(setup, state), 1.2 * (start + fall + stored));
    }
    // After a fault nothing moves any more.
    if (!engine->fault().empty()) {
        engine->run(10);
        EXPECT_EQ(state_of(*engine).position, state.position);
    }
    return engine->fault();
}

TEST(DemCorners, LargeTimeStepsAreSoundOrReported) {
    for (const double restitution : {1.0, 0.5, 0.1})
        for (const double share : {0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 10.0}) {
            auto setup = tests::boxed_gas(125, 0.3, 1, 2);
            setup.gravity = {0, 0, -9.81};
            setup.material.restitution = restitution;
            setup.time_step = share * std::min(dem::rayleigh_time(setup.material, 0.001),
                                               dem::hertz_contact_time(setup.material, 0.001, 1.0));
            const auto fault = verdict(setup, static_cast<std::int64_t>(0.05 / setup.time_step));
            if (share <= 0.1) {
                EXPECT_EQ(fault, "") << restitution << " " << share;
            }
            if (share >= 10) {
                EXPECT_NE(fault, "") << restitution << " " << share;
            }
        }
}

TEST(DemCorners, OverlappingInsertionIsSoundOrReported) {
    for (const double distance : {0.0, 1e-9, 0.0005, 0.0013, 0.0015, 0.0019, 0.00199999}) {
        auto setup = tests::empty_space();
        setup.spheres = {{{0, 0, 0}, {}, {}, 0.001, true}, {{distance, 0, 0}, {}, {}, 0.001, true}};
        const double stored =
            8.0 / 15.0 * dem::effective_modulus(setup.material) * std::sqrt(0.0005) * std::pow(0.002 - distance, 2.5);
        const auto fault = verdict(setup, 2000, stored);
        const double overlap = (0.002 - distance) / 0.002;
        if (overlap > dem::largest_sound_overlap)
            EXPECT_NE(fault.find("overlap"), std::string::npos) << distance;
        else
            EXPECT_EQ(fault, "") << distance;
    }
    auto setup = tests::empty_space();  // two at the same place among many, and one inside a wall
    setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    setup.spheres = {{{0, 0, -0.0005}, {}, {}, 0.001, true}};
    EXPECT_NE(verdict(setup, 10).find("wall 0"), std::string::npos);
}

TEST(DemCorners, NobodyOneAndTwoAreServed) {
    for (std::size_t n = 0; n <= 2; ++n)
        for (const bool friction : {true, false}) {
            auto setup = tests::boxed_gas(n, 0.1, 1, 3);
            setup.domain = {{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {false, true, false}};
            setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
            setup.gravity = {0, 0, -9.81};
            if (!friction) setup.material.friction = 0;
            EXPECT_EQ(verdict(setup, 3000), "") << n;
        }
}

TEST(DemCorners, FastImpactsAreSoundOrReported) {
    for (const double speed : {10.0, 100.0, 1e4})
        for (const double step : {1e-8, 1e-6, 1e-5, 1e-4}) {
            auto setup = tests::empty_space();
            setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
            setup.time_step = step;
            setup.spheres = {{{0, 0, 0.0012}, {0, 0, -speed}, {}, 0.001, true},
                             {{0, 0, 0.0035}, {3, 0, -speed}, {}, 0.001, true}};
            const auto fault = verdict(setup, 200);
            if (speed * step > 0.002) {
                EXPECT_NE(fault, "") << speed << " " << step;
            }
        }
}

TEST(DemCorners, FaultsSayWhatWhereAndWhen) {
    auto setup = tests::empty_space();
    setup.time_step = 1e-4;
    setup.spheres = {{{0.1, 0.2, 0.3}, {100, 0, 0}, {}, 0.001, true}};
    const auto fault = verdict(setup, 5);
    EXPECT_NE(fault.find("10 of its radius in one time step"), std::string::npos) << fault;
    EXPECT_NE(fault.find("particle 0 at (0.11, 0.2, 0.3) m"), std::string::npos) << fault;
    EXPECT_NE(fault.find("after 1 steps, 0.0001 s"), std::string::npos) << fault;
}

TEST(DemCorners, ImpossibleSetupsAreRefusedInOneSentence) {
    const auto refused = [](auto&& change) {
        auto setup = tests::boxed_gas(2, 0.1, 1, 3);
        change(setup);
        EXPECT_THROW((void)dem::make_engine(setup, {}), std::invalid_argument);
    };
    refused([](dem::Setup& s) { s.time_step = 0; });
    refused([](dem::Setup& s) { s.time_step = std::nan(""); });
    refused([](dem::Setup& s) { s.spheres[0].radius = -1; });
    refused([](dem::Setup& s) { s.spheres[1].velocity[0] = std::nan(""); });
    refused([](dem::Setup& s) { s.material.restitution = 0; });
    refused([](dem::Setup& s) { s.material.friction = -0.1; });
    refused([](dem::Setup& s) { s.material.rolling_friction = -0.1; });
    refused([](dem::Setup& s) { s.material.rolling_friction = 1.1; });
    refused([](dem::Setup& s) { s.material.rolling_damping = 2; });
    refused([](dem::Setup& s) { s.material.youngs_modulus = std::numeric_limits<double>::infinity(); });
    refused([](dem::Setup& s) { s.domain.high = s.domain.low; });
    refused([](dem::Setup& s) { s.domain.periodic = {true, true, true}, s.domain.high = {0.003, 1, 1}; });
    refused([](dem::Setup& s) { s.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 2}}); });
    refused([](dem::Setup& s) { s.spheres[0].mobile = false; });
}

// The same bits again, and after a checkpoint at any time, for every combination of laws and columns.
TEST(DemCorners, CheckpointsContinueBitForBit) {
    for (const double ratio : {1.0, 3.0})
        for (const bool frozen : {false, true})
            for (const double friction : {0.0, 0.4})
                for (const auto& [cohesion, rolling] :
                     {std::pair(0.0, 0.0), std::pair(1e4, 0.0), std::pair(0.0, 0.2)}) {
                    auto setup = tests::boxed_gas(64, 0.4, ratio, 6);
                    setup.material.rolling_friction = rolling;
                    setup.gravity = {0, 0, -9.81};
                    setup.material.friction = friction;
                    setup.material.cohesion = cohesion;
                    setup.walls.emplace_back(Blade{0.0, 0.001, 0.004, 0.02, 0.5, 5e-4, 200, 0});
                    if (frozen) {
                        setup.spheres[20].velocity = {};
                        setup.spheres[20].mobile = false;
                    }
                    const auto straight = dem::make_engine(setup, {});
                    straight->run(700);
                    ASSERT_EQ(straight->fault(), "");
                    const auto first = dem::make_engine(setup, {});
                    first->run(123);
                    first->run(210);
                    std::vector<std::byte> bytes;
                    first->save(bytes);
                    const auto second = dem::make_engine(setup, {});
                    second->run(50);
                    second->restore(bytes);
                    second->run(367);
                    std::vector<std::byte> a;
                    std::vector<std::byte> b;
                    straight->save(a);
                    second->save(b);
                    EXPECT_EQ(a, b);
                    setup.time_step *= 2;
                    const auto other = dem::make_engine(setup, {});
                    EXPECT_THROW(other->restore(bytes), std::invalid_argument);
                    EXPECT_THROW(second->restore(std::span<const std::byte>(bytes).first(bytes.size() - 1)),
                                 std::invalid_argument);
                }
}

}  // namespace grainsweep::tests::dem_corners_test
