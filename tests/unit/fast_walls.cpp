// Walls in the mixed engine: their own surface, checkpoints, removal, what is reported and refused, periodic images.
#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"
#include "tests/support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests::fast_walls_test {

using dem::fast::make_mixed_engine;
using namespace geometry;

/// A turning drum with end plates, half full, a bar and a block of triangles in it.
dem::Setup drum_of_spheres() {
    dem::Setup s = tests::boxed_lattice(6, 0.3, 0.2, 3);
    dem::Vec3 c{};
    for (const auto& p : s.spheres) c += (1.0 / static_cast<double>(s.spheres.size())) * p.position;
    const dem::Rotation turns{.point = c, .axis = {0, 1, 0}, .speed = 60};
    const dem::Vec3 half{0, 5.5e-3, 0};
    auto lug = tests::box(1e-3, 2e-3);
    for (auto& triangle : lug)
        for (dem::Vec3& x : triangle) x += c + dem::Vec3{0, 0, 6.9e-3};
    s.walls = {{dem::Cylinder{.point = c, .axis = {0, 1, 0}, .radius = 7e-3}, {turns}, {.friction = 0.6}},
               {dem::Plane{c - half, {0, 1, 0}}, {turns}},
               {dem::Plane{c + half, {0, -1, 0}}, {turns}},
               {dem::Bar{c[0] + 0.5e-3, 1e-3, c[2] - 7e-3, c[2] - 4.8e-3}, {turns}},
               {dem::Mesh(tests::surface_of(lug)), {turns}, {.friction = 0.4}}};
    for (std::size_t k = 0; k < 3; ++k) s.domain.low[k] = c[k] - 9e-3, s.domain.high[k] = c[k] + 9e-3;
    return s;
}

TEST(FastWalls, AWallHasItsOwnSurface) {
    for (const auto path : tests::paths()) {
        auto setup =
            one_sphere({0, 0, 1.001e-3}, {0.3, 0, -0.3}, {{dem::Plane{}, {}, {.friction = 0.1, .restitution = 0.9}}});
        const auto own = make_mixed_engine(setup, path);
        setup.walls = {dem::Plane{}};
        setup.material.friction = 0.1;
        setup.material.restitution = 0.9;
        const auto all = make_mixed_engine(setup, path);
        own->run(600), all->run(600);
        EXPECT_EQ(tests::state_of(*own).velocity, tests::state_of(*all).velocity);
        EXPECT_EQ(tests::state_of(*own).angular_velocity, tests::state_of(*all).angular_velocity);
        setup.material.friction = 0;
        setup.walls = {{dem::Plane{}, {}, {.friction = 0.1, .rolling_friction = 0.2}}};
        const auto rough = make_mixed_engine(setup, path);
        rough->run(600);
        EXPECT_GT(std::abs(tests::state_of(*rough).angular_velocity[0][1]), 10);
        setup.walls = {dem::Plane{}};
        const auto smooth = make_mixed_engine(setup, path);
        EXPECT_THROW(smooth->set_walls({{dem::Plane{}, {}, {.friction = 0.1}}}), std::invalid_argument);
        EXPECT_THROW(smooth->set_walls({{dem::Plane{}, {}, {.restitution = 0}}}), std::invalid_argument);
        EXPECT_NO_THROW(smooth->set_walls({{dem::Plane{}, {}, {.restitution = 0.9}}}));
    }
}

// Bit for bit, in the middle of contacts, with walls that turn; the walls of a checkpoint take the place of others.
TEST(FastWalls, CheckpointsContinueBitForBit) {
    for (const auto path : tests::paths()) {
        for (const auto& m : all_moving_walls()) {
            SCOPED_TRACE(m.name);
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.material.rolling_friction = 0.1;
            setup.walls[0].surface.friction = 0.7;
            const auto first = make_mixed_engine(setup, path);
            setup.walls.clear();
            const auto second = make_mixed_engine(setup, path);
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
        const auto first = make_mixed_engine(drum_of_spheres(), path),
                   second = make_mixed_engine(drum_of_spheres(), path);
        std::vector<std::byte> half, whole, again;
        first->run(777);
        first->save(half);
        second->restore(half);
        first->remove(std::vector<std::int32_t>{3, 100, 200}), second->remove(std::vector<std::int32_t>{3, 100, 200});
        first->run(1500), second->run(1500);
        EXPECT_EQ(first->fault(), "");
        first->save(whole), second->save(again);
        EXPECT_EQ(whole, again);
    }
}

// Lists follow turning walls: with a skin that needs many new lists and one that needs few the same motion follows, up
// to the order of sums.
TEST(FastWalls, ListsFollowTurningWalls) {
    const auto setup = drum_of_spheres();
    const auto often = make_mixed_engine(setup, dem::Method::Path::best, 0.02e-3),
               rarely = make_mixed_engine(setup, dem::Method::Path::best, 0.6e-3);
    often->run(500), rarely->run(500);
    EXPECT_EQ(often->fault(), "");
    EXPECT_GT(often->work().rebuilds, 4 * rarely->work().rebuilds);
    EXPECT_LT(tests::velocity_difference(tests::state_of(*often), tests::state_of(*rarely)), 1e-3);
    for (std::size_t w = 0; w < setup.walls.size(); ++w)
        EXPECT_LT(norm(often->wall_load(w, {}).force - rarely->wall_load(w, {}).force),
                  0.02 * norm(rarely->wall_load(w, {}).force) + 1e-5);
}

// The work of the walls is booked: none of what they give is taken for energy from nowhere, however long they turn.
TEST(FastWalls, WorkOfTurningWallsIsBalanced) {
    auto setup = drum_of_spheres();
    setup.material.restitution = 1;
    setup.material.friction = 0.3;
    const auto engine = make_mixed_engine(setup, dem::Method::Path::best);
    engine->run(20000);
    EXPECT_EQ(engine->fault(), "");
    double work = 0;
    for (std::size_t w = 0; w < setup.walls.size(); ++w) work += engine->wall_load(w, {}).work;
    EXPECT_GT(work, 0);
}

TEST(FastWalls, AWallTooFastForTheStepIsReported) {
    const auto fault = [](const dem::Wall& wall) {
        const auto engine = make_mixed_engine(one_sphere({0, 0, 5e-3}, {}, {wall}), dem::Method::Path::best);
        engine->run(1);
        return engine->fault();
    };
    EXPECT_NE(
        fault({dem::Plane{}, {dem::Translation{.velocity = {0, 0, 1100}}}}).find("wall 0 moves at 1100 m/s, 1.1 of"),
        std::string::npos);
    EXPECT_EQ(fault({dem::Plane{}, {dem::Translation{.velocity = {1100, 0, 0}}}}), "") << "a belt";
    EXPECT_NE(fault({dem::Bar{0.02, 0.01, 0.02, 0.03, 0}, {dem::Rotation{.speed = 1e5}}}), "");
}

// A sphere and a sheet that move towards one another by 0.9 R together in a step.
TEST(FastWalls, PassingASheetIsReported) {
    const dem::Mesh sheet(tests::surface_of(tests::plate(0.02, 2)));
    auto setup = one_sphere({}, {0, 0, -45}, {{sheet, {dem::Translation{.velocity = {0, 0, 45}}}}});
    setup.material.youngs_modulus = 5e6;
    setup.time_step = 1e-5;
    const auto fault = [&](const dem::Vec3& start) {
        setup.spheres[0].position = start;
        const auto engine = make_mixed_engine(setup, dem::Method::Path::best);
        engine->run(3);
        return engine->fault();
    };
    for (const double start : {1.05e-3, 1.2e-3, 1.4e-3, 1.7e-3}) EXPECT_NE(fault({0.001, 0.0005, start}), "") << start;
    EXPECT_NE(fault({0.001, 0.0005, 1.4e-3}).find("passed through wall 0"), std::string::npos)
        << fault({0.001, 0.0005, 1.4e-3});
    EXPECT_EQ(fault({0.0215, 0, 1.2e-3}), "") << "beside the sheet";
}

// Across a periodic face a roller is met through its image, with the velocity of its surface there.
TEST(FastWalls, PeriodicImagesAreMet) {
    const dem::Cylinder roller{.point = {0.0495, 0, 0}, .axis = {0, 1, 0}, .radius = 2e-3, .side = dem::Side::outside};
    const dem::Rotation turns{.point = roller.point, .axis = {0, 1, 0}, .speed = 100};
    auto setup = one_sphere({-0.0505 + 2e-3 + 1.01e-3, 0, 0}, {-0.3, 0, 0}, {{roller, {turns}}});
    auto beside = setup;
    setup.domain.periodic = {true, true, false};
    const auto across = make_mixed_engine(setup, dem::Method::Path::best);
    beside.spheres[0].position[0] = 0.0495 + 2e-3 + 1.01e-3;
    beside.domain.high[0] = 0.06;
    const auto straight = make_mixed_engine(beside, dem::Method::Path::best);
    across->run(600), straight->run(600);
    const auto a = tests::state_of(*across), b = tests::state_of(*straight);
    EXPECT_NEAR(a.velocity[0][0], 0.15, 5e-3);
    EXPECT_GT(std::abs(b.velocity[0][2]), 0.05) << "carried along";
    EXPECT_LT(norm(a.velocity[0] - b.velocity[0]), 1e-5);
    EXPECT_LT(norm(a.angular_velocity[0] - b.angular_velocity[0]), 1e-2);
}

}  // namespace grainsweep::tests::fast_walls_test
