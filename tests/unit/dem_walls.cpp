// Walls in an engine: their own surface, checkpoints, what is reported and refused, periodic images.
#include "solver/dem/engine.hpp"
#include "stats/random.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests::dem_walls_test {

using namespace geometry;

// A surface of its own: the wall's friction where it slides, its restitution, and none of it between spheres.
TEST(DemWalls, AWallHasItsOwnSurface) {
    auto setup =
        one_sphere({0, 0, 1.001e-3}, {0.3, 0, -0.3}, {{dem::Plane{}, {}, {.friction = 0.1, .restitution = 0.9}}});
    const auto own = dem::make_engine(setup, {});
    setup.walls = {dem::Plane{}};
    setup.material.friction = 0.1;
    setup.material.restitution = 0.9;
    const auto all = dem::make_engine(setup, {});
    own->run(600), all->run(600);
    EXPECT_EQ(tests::state_of(*own).velocity, tests::state_of(*all).velocity);
    EXPECT_EQ(tests::state_of(*own).angular_velocity, tests::state_of(*all).angular_velocity);
    EXPECT_NEAR(tests::state_of(*own).velocity[0][2], 0.9 * 0.3, 1e-3);
    // Gross sliding: v_t' = v_t - mu (1 + e) v_n.
    EXPECT_NEAR(tests::state_of(*own).velocity[0][0], 0.3 - 0.1 * 1.9 * 0.3, 2e-3);

    // Friction at a wall only, rolling friction at a wall only: the powder has none, and walls set later may have none
    // that nothing had at the start.
    setup.material.friction = 0;
    setup.walls = {{dem::Plane{}, {}, {.friction = 0.1}}};
    const auto rough = dem::make_engine(setup, {});
    rough->run(600);
    EXPECT_GT(std::abs(tests::state_of(*rough).angular_velocity[0][1]), 10);
    setup.walls = {{dem::Plane{}, {}, {.friction = 0.1, .rolling_friction = 0.2}}};
    const auto rolling = dem::make_engine(setup, {});
    rolling->run(600);
    EXPECT_LT(std::abs(tests::state_of(*rolling).angular_velocity[0][1]),
              std::abs(tests::state_of(*rough).angular_velocity[0][1]));
    setup.walls = {dem::Plane{}};
    const auto smooth = dem::make_engine(setup, {});
    EXPECT_THROW(smooth->set_walls({{dem::Plane{}, {}, {.friction = 0.1}}}), std::invalid_argument);
    EXPECT_THROW(smooth->set_walls({{dem::Plane{}, {}, {.restitution = 0}}}), std::invalid_argument);
}

// A checkpoint is the walls' parameters and their time: an engine with other walls goes on with those it was saved
// with.
TEST(DemWalls, CheckpointsContinueBitForBit) {
    for (const auto& m : all_moving_walls()) {
        SCOPED_TRACE(m.name);
        auto setup = one_sphere(m.position, m.velocity, {m.wall});
        setup.material.rolling_friction = 0.1;
        setup.walls[0].surface.friction = 0.7;
        setup.walls[0].surface.cohesion = 1e4;
        const auto first = dem::make_engine(setup, {});
        setup.walls.clear();
        const auto second = dem::make_engine(setup, {});
        std::vector<std::byte> half, whole, again;
        for (int k = 0; k < 600 && norm(first->wall_load(0, {}).force) == 0; ++k) first->run(1);
        first->run(20);
        ASSERT_GT(norm(first->wall_load(0, {}).force), 0) << "in contact";
        first->save(half);
        second->restore(half);
        EXPECT_EQ(second->wall_load(0, {}).torque, first->wall_load(0, {}).torque);
        first->run(900), second->run(900);
        first->save(whole), second->save(again);
        EXPECT_EQ(whole, again);
    }
}

// A wall that moves farther than a radius in one step could pass a sphere unseen.
TEST(DemWalls, AWallTooFastForTheStepIsReported) {
    const auto fault = [](const dem::Wall& wall) {
        const auto engine = dem::make_engine(one_sphere({0, 0, 5e-3}, {}, {wall}), {});
        engine->run(1);
        return engine->fault();
    };
    EXPECT_NE(
        fault({dem::Plane{}, {dem::Translation{.velocity = {0, 0, 1100}}}}).find("wall 0 moves at 1100 m/s, 1.1 of"),
        std::string::npos);
    EXPECT_EQ(fault({dem::Plane{}, {dem::Translation{.velocity = {1100, 0, 0}}}}), "") << "a belt";
    EXPECT_NE(fault({dem::Bar{0.02, 0.01, 0.02, 0.03, 0}, {dem::Rotation{.speed = 1e5}}}), "");
}

TEST(DemWalls, WhatCannotBeIsRefused) {
    const auto refused = [](const dem::Wall& wall, std::array<bool, 3> periodic = {}) {
        auto setup = one_sphere({}, {}, {wall});
        setup.domain.periodic = periodic;
        EXPECT_THROW((void)dem::make_engine(setup, {}), std::invalid_argument);
    };
    refused(dem::Cylinder{.radius = 0});
    refused(dem::Cylinder{.axis = {0, 0, 2}, .radius = 1e-2});
    refused(dem::Cylinder{.radius = 1e-2, .length = -1});
    refused(dem::Cone{.base_radius = 1e-2, .end_radius = -1e-3, .length = 1e-2});
    refused(dem::Cone{.base_radius = 1e-2, .end_radius = 1e-3});
    refused({dem::Plane{}, {dem::Rotation{.axis = {0, 0, 3}, .speed = 1}}});
    refused({dem::Plane{}, {dem::Translation{.velocity = {1, 0, 0}, .start = 2, .end = 1}}});
    refused({dem::Plane{}, {}, {.friction = -1}});
    refused({dem::Plane{}, {}, {.cohesion = -1}});
    refused(dem::Plane{}, {false, false, true});
    refused(dem::Cylinder{.radius = 1e-2}, {true, false, false});  // no end across, nor an image
    refused({dem::Plane{}, {dem::Rotation{.axis = {0, 1, 0}, .speed = 1}}}, {true, false, false});
    auto setup = one_sphere(
        {}, {},
        {dem::Cylinder{.radius = 1e-2}, dem::Cylinder{.radius = 1e-3, .side = dem::Side::outside, .length = 2e-3}});
    setup.walls[1].motions = {dem::Translation{.velocity = {0.1, 0, 0}}};
    setup.spheres[0].position = {5e-3, 0, 0};
    setup.domain.periodic = {false, false, true};
    EXPECT_NO_THROW((void)dem::make_engine(setup, {}));
}

// Across a periodic face a roller is met through its image, with the velocity of its surface there, and feels it so.
TEST(DemWalls, PeriodicImagesAreMet) {
    const dem::Cylinder roller{.point = {0.0495, 0, 0}, .axis = {0, 1, 0}, .radius = 2e-3, .side = dem::Side::outside};
    const dem::Rotation turns{.point = roller.point, .axis = {0, 1, 0}, .speed = 100};
    auto setup = one_sphere({-0.0505 + 2e-3 + 1.01e-3, 0, 0}, {-0.3, 0, 0}, {{roller, {turns}}});
    auto beside = setup;
    setup.domain.periodic = {true, true, false};
    const auto across = dem::make_engine(setup, {});
    beside.spheres[0].position[0] = 0.0495 + 2e-3 + 1.01e-3;
    beside.domain.high[0] = 0.06;
    const auto straight = dem::make_engine(beside, {});
    bool touched = false;
    std::vector<dem::ContactForce> here, there;
    for (int k = 0; k < 60; ++k) {
        across->run(10), straight->run(10);
        const auto load = across->wall_load(0, roller.point), expected = straight->wall_load(0, roller.point);
        EXPECT_LT(norm(load.force - expected.force), 1e-8 * (norm(expected.force) + 1));
        EXPECT_LT(norm(load.torque - expected.torque), 1e-8 * (norm(expected.torque) + 1e-3));
        EXPECT_NEAR(load.work, expected.work, 1e-9 * (std::abs(expected.work) + 1e-6));
        across->contacts(here), straight->contacts(there);
        ASSERT_EQ(here.size(), there.size());
        if (here.empty()) continue;
        touched = true;
        EXPECT_LT(norm(here[0].tangential_force - there[0].tangential_force),
                  1e-8 * (norm(there[0].tangential_force) + 1));
    }
    EXPECT_TRUE(touched);
    const auto a = tests::state_of(*across), b = tests::state_of(*straight);
    EXPECT_NEAR(a.velocity[0][0], 0.15, 5e-3);
    EXPECT_GT(std::abs(b.velocity[0][2]), 0.05) << "carried along";
    EXPECT_LT(norm(a.velocity[0] - b.velocity[0]), 1e-9);
    EXPECT_LT(norm(a.angular_velocity[0] - b.angular_velocity[0]), 1e-6);
}

// Whatever the bytes of a mesh in a checkpoint are, it is refused with a sentence or goes on to an answer or a fault.
TEST(DemWalls, AlteredCheckpointsOfAMeshAreRefusedOrGoOn) {
    const auto moving = tests::moving_meshes().back();
    auto setup = one_sphere(moving.position, moving.velocity, {moving.wall});
    const auto engine = dem::make_engine(setup, {});
    engine->run(60);
    std::vector<std::byte> sound;
    engine->save(sound);
    int refused = 0;
    for (std::uint64_t trial = 0; trial < 300; ++trial) {
        stats::Generator chance(trial);
        auto bytes = sound;
        const std::size_t at = chance.below(bytes.size() / 8 - 1) * 8;
        constexpr std::array<double, 6> numbers = {0, -1, 1e-3, 1e8, 1e300, std::numeric_limits<double>::quiet_NaN()};
        constexpr std::array<std::int64_t, 5> wholes = {0, 1, 11, 1 << 20, std::numeric_limits<std::int64_t>::max()};
        switch (chance.below(4)) {
            case 0:
                bytes[at + chance.below(8)] ^= static_cast<std::byte>(1U << chance.below(8));
                break;
            case 1:
                std::memcpy(bytes.data() + at, &numbers.at(chance.below(numbers.size())), sizeof(double));
                break;
            case 2:
                std::memcpy(bytes.data() + at, &wholes.at(chance.below(wholes.size())), sizeof(std::int64_t));
                break;
            default:
                bytes.resize(at);
        }
        const auto fresh = dem::make_engine(setup, {});
        try {
            fresh->restore(bytes);
            fresh->run(40);
        } catch (const std::invalid_argument& refusal) {
            EXPECT_GT(std::string(refusal.what()).size(), 5U);
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

}  // namespace grainsweep::tests::dem_walls_test
