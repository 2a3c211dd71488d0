// However many threads compute a case, at every moment its checkpoint has the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/moving_walls.hpp"

using namespace grainsweep;
using dem::Method;
using dem::fast::make_mixed_engine;
using dem::fast::Threads;

namespace {

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
    dem::Setup s = test::boxed_lattice(5, 0.5, spread, 4);
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
    return all;
}

/// Three layers on a frozen floor, which come to rest.
dem::Setup pile() {
    constexpr double d = 1e-3;
    dem::Setup s;
    s.material = test::steel_like();
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

dem::Setup drum(bool of_triangles) {
    dem::Setup s = test::boxed_lattice(4, 0.5, 0, 8);
    s.time_step = 4e-6;
    const dem::Rotation turns{.axis = {0, 1, 0}, .speed = 20};
    const dem::Vec3 middle{s.spheres[0].position[0] + 1.5e-3, 0, s.spheres[0].position[2] + 1.5e-3};
    s.walls.clear();
    s.walls.push_back({dem::Cylinder{.point = middle, .axis = {0, 1, 0}, .radius = 3.5e-3}, {turns}});
    if (of_triangles)
        for (const tests::Moving& m : tests::moving_meshes()) {
            s.walls.push_back(m.wall);
            break;
        }
    return s;
}

std::vector<Case> cases() {
    std::vector<Case> all = laws();
    all.push_back({"a gas in a periodic box", test::thrown_lattice(6, 2.0, 0, 1), 250});
    all.push_back({"a gas of many sizes", test::thrown_lattice(6, 2.0, 0.3, 1), 250});
    all.push_back({"powder at rest", pile(), 1500, 2e-3});
    dem::Setup frozen = test::boxed_lattice(5, 0.5, 0, 3);
    for (std::size_t i = 0; i < frozen.spheres.size(); i += 7) {
        frozen.spheres[i].mobile = false;
        frozen.spheres[i].velocity = frozen.spheres[i].angular_velocity = {};
    }
    all.push_back({"obstacles", frozen, 250});
    all.push_back({"a turning drum", drum(false), 250});
    return all;
}

}  // namespace

TEST(FastThreads, TheirNumberChangesNoByteOfACheckpoint) {
    for (const auto path : paths())
        for (const Case& c : cases()) {
            const auto alone = make_mixed_engine(c.setup, path, 0, c.rest_speed);
            std::vector<std::unique_ptr<dem::Engine>> together;
            for (const int threads : {2, 3, 7})
                together.push_back(make_mixed_engine(c.setup, path, 0, c.rest_speed, small_parts(threads)));
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
        }
}
