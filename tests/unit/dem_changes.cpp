// What changes while a case runs: spheres that are added, walls that move otherwise, come or go; in both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"

namespace grainsweep::tests::dem_changes_test {

using dem::Method;
using namespace geometry;
using Bytes = std::vector<std::byte>;
using Made = std::unique_ptr<dem::Engine>;

struct Precision {
    const char* name;
    double rounding;  // of forces, relative
    Made (*make)(const dem::Setup&);
};

Made clear(const dem::Setup& setup) {
    return dem::make_engine(setup, {});
}
Made mixed(const dem::Setup& setup, int threads) {
    return dem::fast::make_mixed_engine(setup, Method::Path::best, 0, 0, {.most = threads, .least_particles = 5});
}
constexpr Precision engines[] = {
    {"double", 1e-9, clear},
    {"mixed", 1e-4, [](const dem::Setup& setup) { return mixed(setup, 1); }},
    {"mixed, three threads", 1e-4, [](const dem::Setup& setup) { return mixed(setup, 3); }},
};

Bytes bytes_of(const dem::Engine& engine) {
    Bytes bytes;
    engine.save(bytes);
    return bytes;
}

/// A gas in a box without a lid, of which the last spheres are still to come.
struct Announced {
    dem::Setup setup;
    std::vector<dem::Sphere> later;

    explicit Announced(double spread, std::size_t at_the_start = 40) : setup(boxed_lattice(4, 0.5, spread, 5)) {
        setup.time_step = 4e-6;
        later.assign(setup.spheres.begin() + static_cast<std::ptrdiff_t>(at_the_start), setup.spheres.end());
        dem::ToCome range{.smallest = later.front().radius, .largest = later.front().radius};
        for (const dem::Sphere& s : setup.spheres) {
            range.smallest = std::min(range.smallest, s.radius);
            range.largest = std::max(range.largest, s.radius);
        }
        setup.spheres.resize(at_the_start);
        setup.to_come = {range};
        setup.domain.high[2] += 0.1;
    }
    /// Above all others.
    void lift(double height) {
        for (dem::Sphere& s : later) s.position[2] += height;
    }
};

TEST(DemChanges, AddedSpheresMoveAsThoseOfTheStart) {
    for (const auto& [name, rounding, make] : engines)
        for (const double spread : {0.0, 0.3})
            for (const std::size_t at_the_start : {std::size_t{0}, std::size_t{40}}) {
                SCOPED_TRACE(name);
                const Announced case_of(spread, at_the_start);
                dem::Setup complete = case_of.setup;
                complete.spheres.insert(complete.spheres.end(), case_of.later.begin(), case_of.later.end());
                const Made whole = make(complete), grown = make(case_of.setup);
                grown->add(case_of.later);
                EXPECT_EQ(grown->size(), complete.spheres.size());
                whole->run(300);
                grown->run(300);
                EXPECT_EQ(grown->fault(), "");
                const dem::State a = state_of(*whole), b = state_of(*grown);
                EXPECT_EQ(a.id, b.id);
                EXPECT_EQ(a.radius, b.radius);
                EXPECT_LT(velocity_difference(a, b), rounding);
            }
}

TEST(DemChanges, IdsFollowAllEarlierOnes) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        const Announced case_of(0);
        const Made engine = make(case_of.setup);
        const std::span later(case_of.later);
        engine->remove(std::vector<std::int32_t>{39, 38});
        engine->add(later.first(2));
        engine->remove(std::vector<std::int32_t>{41});
        engine->add(later.subspan(2, 1));
        engine->add({});
        const auto ids = state_of(*engine).id;
        EXPECT_EQ(ids.size(), 40U);
        EXPECT_EQ(ids[37], 37);
        EXPECT_EQ(ids[38], 40);
        EXPECT_EQ(ids[39], 42);
    }
}

// However a run is cut, however many threads there are, and whether it was saved on the way: the same bytes.
TEST(DemChanges, ACaseThatGrowsContinuesBitForBit) {
    for (const double spread : {0.0, 0.3}) {
        Announced case_of(spread);
        case_of.lift(5e-3);
        Announced above = case_of;
        above.lift(5e-3);
        const std::span later(case_of.later);
        const auto grow = [&](const Made& engine, std::initializer_list<int> slices) {
            for (const int steps : slices) engine->run(steps);
            engine->add(later.first(10));
        };
        Bytes of_one;
        for (const auto& [name, rounding, make] : engines) {
            SCOPED_TRACE(name);
            const Made whole = make(case_of.setup), cut = make(case_of.setup), restored = make(case_of.setup);
            grow(whole, {100});
            grow(cut, {1, 59, 0, 40});
            whole->run(150), cut->run(150);
            const Bytes half = bytes_of(*whole);
            EXPECT_EQ(half, bytes_of(*cut));
            restored->restore(half);
            for (const Made* engine : {&whole, &cut, &restored}) {
                (*engine)->add(std::span(above.later).subspan(10));
                (*engine)->run(60);
                (*engine)->run(90);
                EXPECT_EQ((*engine)->fault(), "");
            }
            const Bytes all = bytes_of(*whole);
            EXPECT_EQ(all, bytes_of(*cut));
            EXPECT_EQ(all, bytes_of(*restored));
            if (make == engines[1].make) of_one = all;
            if (make == engines[2].make) {
                EXPECT_EQ(all, of_one);
            }
        }
    }
}

TEST(DemChanges, WhatWasNotAnnouncedIsRefused) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        const Announced case_of(0.3);
        const Made engine = make(case_of.setup);
        const Bytes before = bytes_of(*engine);
        const auto refuse = [&](void (*spoil)(dem::Sphere&)) {
            std::vector<dem::Sphere> spheres = case_of.later;
            spoil(spheres.back());
            EXPECT_THROW(engine->add(spheres), std::invalid_argument);
        };
        refuse([](dem::Sphere& s) { s.radius *= 2; });
        refuse([](dem::Sphere& s) { s.radius *= 0.3; });
        refuse([](dem::Sphere& s) { s.kind = 1; });
        refuse([](dem::Sphere& s) { s.mobile = false, s.velocity = s.angular_velocity = {}; });
        refuse([](dem::Sphere& s) { s.position[0] = std::nan(""); });
        EXPECT_EQ(bytes_of(*engine), before);
        dem::Setup setup = case_of.setup;
        setup.to_come.clear();
        EXPECT_THROW(make(setup)->add(case_of.later), std::invalid_argument);
        for (const dem::ToCome& wrong :
             {dem::ToCome{.smallest = 0, .largest = 1e-3}, dem::ToCome{.smallest = 2e-3, .largest = 1e-3},
              dem::ToCome{.smallest = 1e-3, .largest = 1e-3, .kind = 1}}) {
            setup.to_come = {wrong};
            EXPECT_THROW((void)make(setup), std::invalid_argument);
        }
    }
}

/// A sphere at rest on a slope that also has a step in front of it.
dem::Setup on_a_slope() {
    dem::Setup s = one_sphere({0, 0, 0.999e-3}, {}, {dem::Plane{}, dem::Plane{{0.02, 0, 0}, {-1, 0, 0}}});
    s.gravity = {2, 0, -9};
    s.material.friction = 0.7;
    s.material.rolling_friction = 0.4;
    s.time_step = 5e-6;
    return s;
}

TEST(DemChanges, HistoriesAndWorkGoOn) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        dem::Setup setup = on_a_slope();
        setup.walls[0].motions = {dem::Translation{.velocity = {0, 0, 1e-3}}};
        const Made engine = make(setup);
        engine->run(4000);
        std::vector<dem::ContactForce> before, after;
        engine->contacts(before);
        ASSERT_EQ(before.size(), 1U);
        const double work = engine->wall_load(0, {}).work, time = engine->wall_time();
        ASSERT_GT(norm(before[0].tangential_force), 0);
        ASSERT_GT(work, 0);
        setup.walls[1].present = false;
        engine->change_walls(setup.walls);
        engine->contacts(after);
        ASSERT_EQ(after.size(), 1U);
        EXPECT_NEAR(norm(after[0].tangential_force - before[0].tangential_force) / norm(before[0].tangential_force), 0,
                    1e-3);
        EXPECT_EQ(engine->wall_time(), time);
        EXPECT_EQ(engine->wall_load(0, {}).work, work);
        // It stops where it stands.
        setup.walls[0].motions = {dem::Translation{.velocity = {0, 0, 1e-3}, .end = time}};
        engine->change_walls(setup.walls);
        EXPECT_EQ(engine->wall_load(0, {}).work, work);
        engine->run(4000);
        EXPECT_EQ(engine->fault(), "");
        EXPECT_NEAR(state_of(*engine).position[0][2], 1e-3 * time + 1e-3, 2e-6);
        EXPECT_NEAR(engine->wall_load(0, {}).work, work, 0.01 * work);
    }
}

TEST(DemChanges, NothingTouchesAnAbsentWall) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        dem::Setup setup = on_a_slope();
        setup.walls[0].motions = {dem::Translation{.velocity = {0, 0, 1}, .start = 1}};
        const Made engine = make(setup);
        engine->run(2000);
        ASSERT_GT(norm(engine->wall_load(0, {}).force), 0);
        setup.walls[0].present = false;
        setup.walls[0].motions = {dem::Translation{.velocity = {0, 0, 1e6}, .start = 1}};  // no limit of its own
        engine->change_walls(setup.walls);
        std::vector<dem::ContactForce> contacts;
        engine->contacts(contacts);
        EXPECT_TRUE(contacts.empty());
        EXPECT_EQ(norm(engine->wall_load(0, {}).force), 0);
        const dem::State then = state_of(*engine);
        engine->run(400);
        EXPECT_EQ(engine->fault(), "");
        const double time = 400 * setup.time_step;
        EXPECT_NEAR(state_of(*engine).position[0][2],
                    then.position[0][2] + time * then.velocity[0][2] - 4.5 * time * time, 1e-9);
        // It comes back, and remembers nothing.
        setup.walls[0].present = true;
        setup.walls[0].motions.clear();
        engine->change_walls(setup.walls);
        engine->contacts(contacts);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_GT(contacts[0].normal_force, 0);
    }
}

// Walls that are absent from the start change no bit.
TEST(DemChanges, AWallThatIsStillToComeChangesNothing) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        dem::Setup setup = boxed_lattice(4, 0.5, 0.2, 6);
        const Made without = make(setup);
        dem::Wall lid = setup.walls.front();
        lid.present = false;
        lid.motions = {dem::Translation{.velocity = {1e5, 1e5, 1e5}}};
        setup.walls.push_back(lid);
        const Made with = make(setup);
        without->run(400), with->run(400);
        const dem::State a = state_of(*without), b = state_of(*with);
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(a.velocity, b.velocity);
        EXPECT_EQ(a.angular_velocity, b.angular_velocity);
    }
}

TEST(DemChanges, ChangedWallsAreRestored) {
    for (const auto& [name, rounding, make] : engines)
        for (const auto& m : all_moving_walls()) {
            SCOPED_TRACE(name);
            SCOPED_TRACE(m.name);
            const dem::Plane far{{0, 0, 0.04}, {0, 0, -1}};
            dem::Setup setup = one_sphere(m.position, m.velocity, {m.wall, far});
            const Made first = make(setup), second = make(setup);
            for (int k = 0; k < 600 && norm(first->wall_load(0, {}).force) == 0; ++k) first->run(1);
            first->run(20);
            ASSERT_GT(norm(first->wall_load(0, {}).force), 0) << "in contact";
            std::vector<dem::Wall> walls = setup.walls;
            walls[1].present = false;
            walls[0].motions.push_back(dem::Translation{.velocity = {0.01, 0, 0}, .start = first->wall_time()});
            first->change_walls(walls);
            EXPECT_GT(norm(first->wall_load(0, {}).force), 0) << "still in contact";
            first->run(50);
            second->restore(bytes_of(*first));
            first->run(300), second->run(300);
            EXPECT_EQ(bytes_of(*first), bytes_of(*second));
            walls[0].present = false;
            walls[1].present = true;
            first->change_walls(walls), second->change_walls(walls);
            first->run(100), second->run(100);
            EXPECT_EQ(first->fault(), "");
            EXPECT_EQ(bytes_of(*first), bytes_of(*second));
        }
}

TEST(DemChanges, OtherBodiesAreRefused) {
    for (const auto& [name, rounding, make] : engines) {
        SCOPED_TRACE(name);
        const dem::Setup setup = on_a_slope();
        const Made engine = make(setup);
        const auto refuse = [&](auto&& spoil) {
            std::vector<dem::Wall> walls = setup.walls;
            spoil(walls);
            EXPECT_THROW(engine->change_walls(walls), std::invalid_argument);
        };
        refuse([](auto& w) { w.pop_back(); });
        refuse([](auto& w) { w[0].shape = dem::Plane{{0, 0, -1e-3}, {0, 0, 1}}; });
        refuse([](auto& w) { w[0].shape = dem::Cylinder{.radius = 1e-2}; });
        refuse([](auto& w) { w[0].surface.friction = 0.1; });
        refuse([](auto& w) { w[1].motions = {dem::Translation{.start = 2, .end = 1}}; });
        engine->run(10);
        EXPECT_EQ(engine->fault(), "");
    }
}

}  // namespace grainsweep::tests::dem_changes_test
