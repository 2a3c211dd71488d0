// However many threads compute a case, at every moment its checkpoint has the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/surfaces.hpp"

namespace grainsweep::tests::fast_threads_test {

using dem::Method;
using dem::fast::make_mixed_engine;
using dem::fast::Threads;

using Bytes = std::vector<std::byte>;

std::vector<Method::Path> paths() {
    std::vector<Method::Path> all;
    for (const auto p : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512})
        if (dem::fast::supports(p)) all.push_back(p);
    return all;
}

/// Cuts that pay for large cases only, in small ones.
constexpr Threads small_parts(int most) {
    return {.most = most, .least_particles = 5};
}

Bytes bytes_of(const dem::Engine& engine) {
    Bytes bytes;
    engine.save(bytes);
    return bytes;
}

struct Case {
    std::string name;
    dem::Setup setup;
    int steps = 0;
    double rest_speed = 0;
};

dem::Setup in_a_box(double spread, void (*change)(dem::Material&)) {
    dem::Setup s = tests::boxed_lattice(5, 0.5, spread, 4);
    change(s.material);
    s.time_step = 4e-6;
    return s;
}

/// Every list of laws that is compiled, with and without sizes.
std::vector<Case> laws() {
    using dem::CohesionLaw;
    using dem::RollingLaw;
    std::vector<Case> all;
    const auto add = [&](const std::string& name, void (*change)(dem::Material&)) {
        for (const double spread : {0.0, 0.3})
            all.push_back({name + (spread > 0 ? ", many sizes" : ""), in_a_box(spread, change), 150});
    };
    add("frictionless", [](auto& m) { m.friction = 0; });
    add("friction", [](auto&) {});
    add("sjkr", [](auto& m) { m.cohesion = 1e5; });
    add("sjkr2", [](auto& m) { m.cohesion = 1e5, m.cohesion_law = CohesionLaw::sjkr2; });
    add("rolling", [](auto& m) { m.rolling_friction = 0.2; });
    add("constant torque", [](auto& m) { m.rolling_friction = 0.2, m.rolling_law = RollingLaw::cdt; });
    add("jkr", [](auto& m) { m.surface_energy = 0.5, m.cohesion_law = CohesionLaw::jkr; });
    add("jkr, constant torque", [](auto& m) {
        m.surface_energy = 0.5, m.cohesion_law = CohesionLaw::jkr;
        m.rolling_friction = 0.2, m.rolling_law = RollingLaw::cdt;
    });
    add("dmt", [](auto& m) { m.surface_energy = 0.5, m.cohesion_law = CohesionLaw::dmt, m.rolling_friction = 0.1; });
    add("linear", [](auto& m) { m.normal_law = dem::NormalLaw::linear, m.stiffness = 2000; });
    add("linear, sjkr, rolling", [](auto& m) {
        m.normal_law = dem::NormalLaw::linear, m.stiffness = 2000;
        m.cohesion = 1e5, m.rolling_friction = 0.2;
    });
    return all;
}

/// Three layers on a frozen floor, which come to rest.
dem::Setup pile() {
    constexpr double d = 1e-3;
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.friction = 0.5;
    s.time_step = 4e-6;
    s.domain = {{-2 * d, -2 * d, -2 * d}, {8 * d, 8 * d, 20 * d}, {}};
    for (int layer = 0; layer < 4; ++layer) {
        const int side = 6 - layer % 2;
        const double shift = layer % 2 == 0 ? 0 : 0.55;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
                s.spheres.push_back(
                    {{(1.1 * i + shift) * d, (1.1 * j + shift) * d, 0.64 * layer * d}, {}, {}, 0.5 * d, layer > 0});
    }
    return s;
}

/// Two layers, wide enough for several threads to share the walls below: a turning plane, and one at rest in which the
/// same spheres lie less deep.
dem::Setup on_two_floors(double spread) {
    constexpr double d = 1e-3;
    dem::Setup s;
    s.material = tests::steel_like();
    s.time_step = 4e-6;
    s.domain = {{-2 * d, -2 * d, -2 * d}, {32 * d, 32 * d, 10 * d}, {}};
    const stats::Stream draws(3, 1);
    std::uint64_t k = 0;
    for (int layer = 0; layer < 2; ++layer)
        for (int i = 0; i < 26; ++i)
            for (int j = 0; j < 26; ++j) {
                const double radius = 0.5 * d * (1 - spread * draws.uniform(k++));
                s.spheres.push_back({{1.1 * i * d, 1.1 * j * d, (0.51 + 1.01 * layer + 0.1 * draws.uniform(k++)) * d},
                                     {0.3 * draws.uniform(k++), 0, -0.1},
                                     {},
                                     radius,
                                     true});
            }
    s.walls = {{dem::Plane{{}, {0, 0, 1}}, {dem::Rotation{.axis = {0, 0, 1}, .speed = 20}}},
               dem::Plane{{0, 0, -1e-6}, {0, 0, 1}}};
    return s;
}

/// Powder above a floor of triangles, in a drum.
dem::Setup among_triangles() {
    dem::Setup s = tests::boxed_lattice(5, 0.5, 0, 8);
    s.time_step = 4e-6;
    for (dem::Sphere& p : s.spheres) p.position[2] += 2.2e-3;
    s.domain = {{-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}, {}};
    s.walls = {{dem::Mesh(tests::surface_of(tests::plate(0.02, 12))), {dem::Rotation{.speed = 20}}}};
    return s;
}

/// Powder tumbling in a drum of triangles, many of which a sphere is near, and out of its ends.
dem::Setup in_a_drum_of_triangles(double spread) {
    dem::Setup s = tests::boxed_lattice(6, 0.5, spread, 8);
    s.time_step = 4e-6;
    dem::Vec3 middle{};
    const auto share = 1 / static_cast<double>(s.spheres.size());
    for (const dem::Sphere& p : s.spheres)
        for (std::size_t a = 0; a < 3; ++a) middle[a] += share * p.position[a];
    for (dem::Sphere& p : s.spheres)
        for (std::size_t a = 0; a < 3; ++a) p.position[a] -= middle[a];
    s.domain = {{-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}, {}};
    const dem::Rotation turns{.axis = {1, 0, 0}, .speed = 40};
    s.walls = {{dem::Mesh(tests::surface_of(tests::drum(24, 5.5e-3, 6e-3))), {turns}}};
    return s;
}

/// Two kinds, of which the second is denser and rougher.
dem::Setup of_two_kinds(double spread) {
    dem::Setup s = tests::boxed_lattice(5, 0.5, spread, 8);
    dem::Material rough = s.material;
    rough.friction = 0.8;
    rough.restitution = 0.3;
    s.kinds = {{s.material.density, 3 * s.material.density}, {s.material, rough, rough}};
    for (std::size_t i = 0; i < s.spheres.size(); ++i) s.spheres[i].kind = i % 3 == 0 ? 1 : 0;
    for (dem::Wall& wall : s.walls) wall.materials = {s.material, rough};
    return s;
}

/// A cloud that flies apart, fast, out of an open box: lists are made anew all the time, with fewer particles each.
dem::Setup flying_apart(double spread) {
    dem::Setup s = tests::thrown_lattice(6, 3.0, spread, 2);
    s.domain.periodic = {true, false, false};
    for (std::size_t a = 1; a < 3; ++a) s.domain.low[a] -= 1e-5, s.domain.high[a] += 1e-5;
    return s;
}

std::vector<dem::Wall> drum() {
    const dem::Rotation turns{.axis = {0, 1, 0}, .speed = 20};
    return {{dem::Cylinder{.point = {2e-3, 0, 1e-3}, .axis = {0, 1, 0}, .radius = 5e-3}, {turns}},
            dem::Plane{{0, -1e-3, 0}, {0, 1, 0}}};
}

std::vector<Case> cases() {
    std::vector<Case> all = laws();
    all.push_back({"a gas in a periodic box", tests::thrown_lattice(6, 2.0, 0, 1), 250});
    all.push_back({"a gas of many sizes", tests::thrown_lattice(6, 2.0, 0.3, 1), 250});
    all.push_back({"powder at rest", pile(), 1500, 2e-3});
    dem::Setup frozen = tests::boxed_lattice(5, 0.5, 0, 3);
    for (std::size_t i = 0; i < frozen.spheres.size(); i += 7) {
        frozen.spheres[i].mobile = false;
        frozen.spheres[i].velocity = frozen.spheres[i].angular_velocity = {};
    }
    all.push_back({"obstacles", frozen, 250});
    frozen.frozen = {.friction = 0.7, .cohesion = 1e5};
    all.push_back({"obstacles of another surface", frozen, 250});
    all.push_back({"triangles", among_triangles(), 400});
    for (const double spread : {0.0, 0.4}) {
        const std::string sizes = spread > 0 ? ", many sizes" : "";
        all.push_back({"two floors" + sizes, on_two_floors(spread), 300});
        all.push_back({"two kinds" + sizes, of_two_kinds(spread), 500});
        all.push_back({"a drum of triangles" + sizes, in_a_drum_of_triangles(spread), 500});
        all.push_back({"flying apart" + sizes, flying_apart(spread), 400});
    }
    return all;
}

/// What the engines answer, and the forces on their walls.
void expect_same_answers(const dem::Engine& a, const dem::Engine& b, std::size_t walls) {
    std::vector<dem::ContactForce> of_a, of_b;
    a.contacts(of_a);
    b.contacts(of_b);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t k = 0; k < of_a.size(); ++k) {
        EXPECT_EQ(of_a[k].first, of_b[k].first);
        EXPECT_EQ(of_a[k].second, of_b[k].second);
        EXPECT_EQ(of_a[k].normal_force, of_b[k].normal_force);
        EXPECT_EQ(of_a[k].tangential_force, of_b[k].tangential_force);
    }
    for (std::size_t w = 0; w < walls; ++w) {
        EXPECT_EQ(a.wall_load(w, {}).force, b.wall_load(w, {}).force);
        EXPECT_EQ(a.wall_load(w, {}).torque, b.wall_load(w, {}).torque);
        EXPECT_EQ(a.wall_load(w, {}).work, b.wall_load(w, {}).work);
    }
    EXPECT_EQ(a.peak_overlap(), b.peak_overlap());
    EXPECT_EQ(a.work().pair_visits, b.work().pair_visits);
}

TEST(FastThreads, TheirNumberChangesNoByteOfACheckpoint) {
    int number = 0;
    for (const auto path : paths())
        for (const Case& c : cases()) {
            const auto alone = make_mixed_engine(c.setup, path, 0, c.rest_speed);
            std::vector<std::unique_ptr<dem::Engine>> together;
            for (const int threads : {2, number % 5 == 0 ? 7 : 3})
                together.push_back(make_mixed_engine(c.setup, path, 0, c.rest_speed, small_parts(threads)));
            ++number;
            for (const int share : {0, 1, 2, 10, 30, 57}) {
                const std::int64_t steps = share < 3 ? share : c.steps * share / 97;
                alone->run(steps);
                const Bytes expected = bytes_of(*alone);
                for (const auto& engine : together) {
                    engine->run(steps);
                    ASSERT_TRUE(bytes_of(*engine) == expected) << c.name << ", share " << share;
                }
            }
            EXPECT_EQ(alone->fault(), "") << c.name;
            EXPECT_GE(alone->work().rebuilds, 2) << c.name;
            EXPECT_EQ(alone->work().resting_steps > 0, c.rest_speed > 0) << c.name;
        }
}

/// Lists that are made anew at nearly every step, while spheres leave and are taken out.
TEST(FastThreads, RebuildsAreTheSame) {
    for (const auto path : paths())
        for (const double spread : {0.0, 0.4}) {
            const dem::Setup setup = flying_apart(spread);
            constexpr double skin = 2e-5;
            const auto alone = make_mixed_engine(setup, path, skin);
            std::vector<std::unique_ptr<dem::Engine>> together;
            for (const int threads : {2, 3, 7})
                together.push_back(make_mixed_engine(setup, path, skin, 0, small_parts(threads)));
            for (int round = 0; round < 4; ++round) {
                const std::vector<std::int32_t> gone = {round, 40 + round, 41 + round, 200 - round};
                alone->run(50);
                alone->remove(gone);
                for (const auto& engine : together) {
                    engine->run(50);
                    engine->remove(gone);
                    ASSERT_TRUE(bytes_of(*engine) == bytes_of(*alone)) << "round " << round;
                }
            }
            EXPECT_EQ(alone->fault(), "");
            EXPECT_GE(alone->work().rebuilds, 20);
            EXPECT_LT(alone->size(), setup.spheres.size() - 20);
        }
}

TEST(FastThreads, VerbsAnswerTheSame) {
    const dem::Setup setup = tests::boxed_lattice(5, 0.5, 0.2, 6);
    for (const auto path : paths()) {
        const auto alone = make_mixed_engine(setup, path),
                   together = make_mixed_engine(setup, path, 0, 0, small_parts(3));
        for (dem::Engine* engine : {alone.get(), together.get()}) {
            engine->run(120);
            engine->remove(std::vector<std::int32_t>{1, 50, 51, 124});
            engine->run(100);
            engine->set_walls(drum());
            engine->run(1);
            engine->run(1300);  // through a check of the energy
        }
        EXPECT_EQ(alone->fault(), "");
        EXPECT_TRUE(bytes_of(*alone) == bytes_of(*together));
        expect_same_answers(*alone, *together, drum().size());
    }
}

TEST(FastThreads, CheckpointsPassBetweenNumbersOfThreads) {
    for (const auto path : paths())
        for (const double rest : {0.0, 2e-3}) {
            const dem::Setup setup = rest > 0 ? pile() : tests::boxed_lattice(5, 0.5, 0, 7);
            const auto alone = make_mixed_engine(setup, path, 0, rest);
            Bytes bytes = bytes_of(*alone);
            for (const int threads : {2, 7, 1, 3, 3}) {  // each goes on from where the one before stopped
                const auto next = make_mixed_engine(setup, path, 0, rest, small_parts(threads));
                next->run(33);  // what was there before the state was restored leaves no trace
                next->restore(bytes);
                alone->run(61);
                next->run(61);
                bytes = bytes_of(*next);
                ASSERT_TRUE(bytes == bytes_of(*alone)) << threads << " threads";
            }
        }
}

TEST(FastThreads, TheirNumberMayChangeInTheMiddle) {
    const auto path = paths().back();
    for (const dem::Setup& setup : {tests::boxed_lattice(5, 0.5, 0.2, 7), of_two_kinds(0), of_two_kinds(0.2)}) {
        const auto alone = make_mixed_engine(setup, path);
        const auto changing = make_mixed_engine(setup, path, 0, 0, small_parts(1));
        for (const int threads : {1, 2, 7, 1, 3, 0, 2, 4, 5, 2}) {
            changing->set_threads(threads);
            alone->run(47);
            changing->run(47);
            ASSERT_TRUE(bytes_of(*alone) == bytes_of(*changing))
                << threads << " threads, " << setup.kinds.densities.size() << " kinds";
        }
    }
}

TEST(FastThreads, FaultsAreTheSame) {
    dem::Setup setup = tests::boxed_lattice(5, 3.0, 0, 7);
    setup.time_step = 6e-5;
    const auto path = paths().back();
    const auto alone = make_mixed_engine(setup, path), together = make_mixed_engine(setup, path, 0, 0, small_parts(4));
    for (dem::Engine* engine : {alone.get(), together.get()}) engine->run(3000);
    EXPECT_NE(alone->fault(), "");
    EXPECT_EQ(alone->fault(), together->fault());
    EXPECT_EQ(alone->work().steps, together->work().steps);
}

TEST(FastThreads, DamagedCheckpointsAreRefusedOrComputed) {
    const dem::Setup setup = tests::boxed_lattice(4, 0.5, 0, 7);
    const auto path = paths().back();
    const auto engine = make_mixed_engine(setup, path, 0, 0, small_parts(2));
    engine->run(100);
    const Bytes whole = bytes_of(*engine);
    const stats::Stream stream(9, 1);
    for (std::uint64_t k = 0; k < 200; ++k) {
        Bytes damaged = whole;
        damaged[stream.bits(2 * k) % damaged.size()] ^=
            std::byte{static_cast<unsigned char>(1 + stream.bits(2 * k + 1) % 255)};
        const auto reader = make_mixed_engine(setup, path, 0, 0, small_parts(2));
        try {
            reader->restore(damaged);
            reader->run(2);
        } catch (const std::invalid_argument&) {
        }
    }
}

}  // namespace grainsweep::tests::fast_threads_test
