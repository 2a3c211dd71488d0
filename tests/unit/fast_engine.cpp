// The verbs of the mixed-precision engine: run, set_walls, remove, save, restore, fault.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/scenes/scene.hpp"
#include "tests/support/granular_scenes.hpp"

namespace grainsweep::tests::fast_engine_test {

using dem::Method;
using dem::fast::make_mixed_engine;

std::vector<Method::Path> paths() {
    std::vector<Method::Path> all;
    for (const auto p : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512})
        if (dem::fast::supports(p)) all.push_back(p);
    return all;
}

void expect_same_bits(const dem::Engine& a, const dem::Engine& b) {
    dem::State s, t;
    a.state(s);
    b.state(t);
    EXPECT_EQ(s.id, t.id);
    EXPECT_EQ(s.position, t.position);
    EXPECT_EQ(s.velocity, t.velocity);
    EXPECT_EQ(s.angular_velocity, t.angular_velocity);
    EXPECT_EQ(a.largest_overlap(), b.largest_overlap());
    EXPECT_EQ(a.wall_time(), b.wall_time());
}

dem::Setup one_sphere(const dem::Vec3& velocity) {
    dem::Setup s;
    s.domain = {{0, 0, 0}, {10e-3, 10e-3, 10e-3}, {true, true, true}};
    s.material = tests::steel_like();
    s.gravity = {0, 0, 0};
    s.time_step = 1e-5;
    s.spheres = {{{5e-3, 5e-3, 5e-3}, velocity, {1, 2, 3}, 0.5e-3, true}};
    return s;
}

TEST(FastEngine, StateReturnsTheStart) {
    const dem::Setup setup = tests::boxed_lattice(3, 1.0, 0.2, 1);
    for (const auto path : paths()) {
        const auto engine = make_mixed_engine(setup, path);
        dem::State s;
        engine->state(s);
        ASSERT_EQ(s.id.size(), 27U);
        for (std::size_t i = 0; i < 27; ++i)
            for (std::size_t a = 0; a < 3; ++a) {
                EXPECT_EQ(s.id[i], static_cast<int>(i));
                EXPECT_NEAR(s.position[i][a], setup.spheres[i].position[a], 1e-15);
                EXPECT_NEAR(s.velocity[i][a], setup.spheres[i].velocity[a], 1e-12);
                EXPECT_NEAR(s.angular_velocity[i][a], setup.spheres[i].angular_velocity[a], 1e-6 * 1e3);
            }
    }
}

TEST(FastEngine, HowARunIsCutChangesNoBit) {
    const dem::Setup setup = tests::boxed_lattice(4, 0.5, 0, 2);
    for (const auto path : paths()) {
        const auto whole = make_mixed_engine(setup, path), cut = make_mixed_engine(setup, path);
        whole->run(700);
        dem::State s;
        for (const int n : {1, 1, 0, 98, 300, 7, 293}) {
            cut->run(n);
            cut->state(s);  // looking changes nothing
        }
        expect_same_bits(*whole, *cut);
    }
}

TEST(FastEngine, RestoredEnginesContinueBitForBit) {
    for (const auto& [spread, rolling] : {std::pair(0.0, 0.0), std::pair(0.3, 0.0), std::pair(0.3, 0.2)})
        for (const auto path : paths()) {
            dem::Setup setup = tests::boxed_lattice(4, 0.5, spread, 3);
            setup.material.rolling_friction = rolling;
            const auto first = make_mixed_engine(setup, path), second = make_mixed_engine(setup, path);
            first->run(350);
            std::vector<dem::Wall> fewer(setup.walls.begin(), setup.walls.begin() + 2);
            first->set_walls(fewer);
            first->remove(std::vector<std::int32_t>{5, 9});
            first->run(123);
            std::vector<std::byte> bytes;
            first->save(bytes);
            second->restore(bytes);
            expect_same_bits(*first, *second);
            first->run(500);
            second->run(500);
            expect_same_bits(*first, *second);
            EXPECT_EQ(first->work().rebuilds, second->work().rebuilds);
            std::vector<std::byte> a, b;
            first->save(a);
            second->save(b);
            EXPECT_EQ(a.size(), b.size());
        }
}

TEST(FastEngine, ForeignCheckpointsAreRefused) {
    const auto a = make_mixed_engine(tests::boxed_lattice(3, 0.5, 0, 4), Method::Path::best);
    std::vector<std::byte> bytes;
    a->save(bytes);
    auto setup = tests::boxed_lattice(3, 0.5, 0, 4);
    setup.material.friction = 0.3;
    EXPECT_THROW(make_mixed_engine(setup, Method::Path::best)->restore(bytes), std::invalid_argument);
    for (const std::size_t cut : {std::size_t{0}, std::size_t{10}, bytes.size() / 2, bytes.size() - 1}) {
        const std::span<const std::byte> part(bytes.data(), cut);
        EXPECT_THROW(a->restore(part), std::invalid_argument) << cut;
    }
    bytes.push_back(std::byte{0});
    EXPECT_THROW(a->restore(bytes), std::invalid_argument);
}

TEST(FastEngine, AProcessorWithoutAnyPathIsRefusedInOneSentence) {
    EXPECT_TRUE(processor_suffices());
    EXPECT_EQ(unsupported_processor(), "");
    EXPECT_EQ(unsupported_processor(false),
              "this processor lacks AVX2, which the program needs: Intel Core has it since 2013, AMD since 2015.");
}

TEST(FastEngine, PathsAgreeToSinglePrecision) {
    const dem::Setup setup = tests::boxed_lattice(4, 0.5, 0.1, 5);
    dem::State reference, other;
    const auto base = make_mixed_engine(setup, Method::Path::best);
    base->run(200);
    base->state(reference);
    for (const auto path : paths()) {
        const auto engine = make_mixed_engine(setup, path);
        engine->run(200);
        engine->state(other);
        EXPECT_LT(tests::position_difference(reference, other, setup.domain, 1e-3), 1e-6);
        EXPECT_LT(tests::velocity_difference(reference, other), 1e-5);
    }
}

TEST(FastEngine, FreeFlightWrapsAndCounts) {
    for (const auto path : paths()) {
        const auto engine = make_mixed_engine(one_sphere({1.0, -2.0, 0.5}), path);
        engine->run(12345);
        dem::State s;
        engine->state(s);
        const double t = 0.12345;
        const dem::Vec3 x{5e-3 + t, 5e-3 - 2 * t, 5e-3 + 0.5 * t};
        for (std::size_t a = 0; a < 3; ++a) {
            const double wrapped = x[a] - 10e-3 * std::floor(x[a] / 10e-3);
            EXPECT_NEAR(s.position[0][a], wrapped, 1e-7 * t);  // what single precision makes of the increment
        }
        EXPECT_EQ(s.angular_velocity[0][2], static_cast<double>(static_cast<float>(3e-5)) / 1e-5);
        EXPECT_EQ(engine->work().steps, 12345);
        EXPECT_EQ(engine->work().particle_steps, 12345.0);
        EXPECT_EQ(engine->largest_overlap(), 0);
    }
}

TEST(FastEngine, FreeFallKeepsEveryDigitOfGravity) {
    // An increment far below the last digit of the velocity: only the carried rounding makes this come out. It is
    // carried in places of its own where radii differ, through lists made anew and a second sphere that overtakes the
    // first.
    const dem::Vec3 g{3, -5, -9.81}, start{2e-3, 8e-3, 5e-3};
    constexpr double t = 0.02;
    for (const double radius : {0.5e-3, 0.4e-3}) {
        dem::Setup setup = one_sphere({0, 0, 0});
        setup.gravity = g;
        setup.time_step = 1e-7;
        setup.spheres.push_back({start, {0.3, 0, 0}, {}, radius, true});
        for (const auto path : paths()) {
            const auto engine = make_mixed_engine(setup, path);
            for (int part = 0; part < 4; ++part) {
                engine->run(50000);
                engine->remove({});  // none, but all is sorted
            }
            dem::State s;
            engine->state(s);
            for (std::size_t a = 0; a < 3; ++a) {
                const double v = a == 0 ? 0.3 : 0, fall = 0.5 * g[a] * t * t;
                EXPECT_NEAR(s.velocity[0][a], g[a] * t, 9.81 * t * 2e-7) << a;
                EXPECT_NEAR(s.position[0][a], 5e-3 + fall, 1e-9) << a;
                EXPECT_NEAR(s.velocity[1][a], v + g[a] * t, 0.3 * 2e-7) << a;
                EXPECT_NEAR(s.position[1][a], start[a] + v * t + fall, 3e-9) << a;
            }
        }
    }
}

TEST(FastEngine, OpenFacesLetParticlesGo) {
    dem::Setup setup = one_sphere({1, 0, 0});
    setup.domain.periodic = {false, true, true};
    setup.spheres.push_back({{2e-3, 5e-3, 5e-3}, {-1, 0, 0}, {}, 0.5e-3, true});
    setup.spheres.push_back({{5e-3, 2e-3, 5e-3}, {0, 1, 0}, {}, 0.5e-3, true});
    const auto engine = make_mixed_engine(setup, Method::Path::best);
    engine->run(190);
    EXPECT_EQ(engine->size(), 3U);
    engine->run(100);  // 2.9 mm: the second is 0.9 mm past its face, more than the widest skin
    EXPECT_EQ(engine->size(), 2U);
    engine->run(400);
    dem::State s;
    engine->state(s);
    ASSERT_EQ(s.id, (std::vector<std::int32_t>{2}));
    EXPECT_EQ(engine->fault(), "");
    engine->remove(std::vector<std::int32_t>{2, 2, 77});
    EXPECT_EQ(engine->size(), 0U);
    engine->run(1000);
    EXPECT_EQ(engine->fault(), "");
}

TEST(FastEngine, FaultsSayWhatWhereAndWhen) {
    for (const auto path : paths()) {
        dem::Setup fast = one_sphere({60, 0, 0});  // 0.6 diameters in one step
        auto engine = make_mixed_engine(fast, path);
        engine->run(100);
        EXPECT_NE(engine->fault().find("particle 0"), std::string::npos) << engine->fault();
        EXPECT_LE(engine->work().steps, 2);

        dem::Setup deep = one_sphere({0, 0, 0});
        deep.spheres.push_back({{5e-3, 5.5e-3, 5e-3}, {}, {}, 0.5e-3, true});
        engine = make_mixed_engine(deep, path);
        EXPECT_NE(engine->fault().find("overlap of 0.5"), std::string::npos) << engine->fault();
        engine->run(100);
        EXPECT_EQ(engine->work().steps, 0);

        deep.spheres[1].position = deep.spheres[0].position;  // no direction to be pushed in
        engine = make_mixed_engine(deep, path);
        EXPECT_NE(engine->fault().find("overlap"), std::string::npos) << engine->fault();

        dem::Setup stiff = one_sphere({1, 0, 0});
        stiff.domain.periodic = {false, false, false};
        stiff.walls = {dem::Plane{{6e-3, 0, 0}, {-1, 0, 0}}};
        stiff.material.youngs_modulus = 2e3;  // far too soft: the centre comes close to the wall
        engine = make_mixed_engine(stiff, path);
        engine->run(5000);
        EXPECT_NE(engine->fault().find("wall 0"), std::string::npos) << engine->fault();
        dem::State s;
        engine->state(s);
        for (const double x : s.position[0]) EXPECT_TRUE(std::isfinite(x));
    }
}

TEST(FastEngine, ImpossibleSetupsAreRefusedInOneSentence) {
    const auto refused = [](auto change) {
        dem::Setup s = one_sphere({0, 0, 0});
        change(s);
        EXPECT_THROW((void)make_mixed_engine(s, Method::Path::best), std::invalid_argument);
    };
    refused([](dem::Setup& s) { s.time_step = 0; });
    refused([](dem::Setup& s) { s.material.restitution = 0; });
    refused([](dem::Setup& s) { s.material.rolling_friction = -0.1; });
    refused([](dem::Setup& s) { s.spheres[0].radius = -1; });
    refused([](dem::Setup& s) { s.spheres[0].velocity[1] = std::numeric_limits<double>::quiet_NaN(); });
    refused([](dem::Setup& s) { s.domain.high[1] = 1.5e-3; });
    refused([](dem::Setup& s) { s.domain.high[2] = s.domain.low[2]; });
    refused([](dem::Setup& s) { s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}}; });
    refused([](dem::Setup& s) { s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 0}}}; });
}

TEST(FastEngine, MomentumOfAFreeClusterStays) {
    dem::Setup setup = tests::thrown_lattice(5, 1.0, 0.2, 8);
    for (const auto path : paths()) {
        const auto engine = make_mixed_engine(setup, path);
        dem::State s;
        const auto momentum = [&](std::size_t axis) {
            engine->state(s);
            double sum = 0;
            for (std::size_t i = 0; i < s.id.size(); ++i)
                sum += std::pow(s.radius[i] / 0.5e-3, 3) * s.velocity[i][axis];
            return sum;
        };
        double start[3];
        for (std::size_t a = 0; a < 3; ++a) start[a] = momentum(a);
        engine->run(3000);
        ASSERT_EQ(engine->fault(), "");
        // 125 particles of up to 1 m/s: forces on two partners are equal to the last bit, their sums are rounded
        for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(momentum(a), start[a], 2e-4);
    }
}

TEST(FastEngine, FetchesAsFarAheadAsMostPartnersAre) {
    constexpr std::int32_t particles = 4000, layer = 900;
    std::vector<dem::fast::Place> first, second;
    const auto list = [&](std::int32_t a, std::int32_t b) {
        first.push_back(dem::fast::place_at(a));
        second.push_back(dem::fast::place_at(b));
    };
    dem::fast::Field f{};
    f.filler = particles;
    const auto distance = [&] {
        f.inner_count = static_cast<std::int32_t>(first.size()) / 16 * 16;
        f.inner_first = first.data();
        f.inner_second = second.data();
        return dem::fast::distance_to_fetch(f);
    };
    f.end = particles;
    for (std::int32_t i = 0; i < particles; ++i) {
        if (i + 1 < particles) list(i, i + 1);
        if (i + layer < particles) list(i, i + layer);
        if (i < layer) list(i, i + particles - layer);                   // across a periodic face
        if (i >= particles - layer) list(i, particles + 2 + i % layer);  // the copy of another subdomain's
    }
    EXPECT_EQ(distance(), layer + layer / 8 + dem::fast::tile / 2);
    first.resize(particles - 16);
    EXPECT_EQ(distance(), 0);
}

}  // namespace grainsweep::tests::fast_engine_test
