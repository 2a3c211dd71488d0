// A shaken vessel, computed in its own frame by both engines: against free fall, against a plain calculation in the
// laboratory's frame in which the frozen spheres move, and continued from a checkpoint.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "solver/dem/engine.hpp"
#include "solver/geometry/vector.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"

namespace grainsweep::tests::dem_shaking_test {

using dem::Method;
using dem::Vec3;
using geometry::operator-;

class Shaking : public testing::TestWithParam<Method::Precision> {
protected:
    [[nodiscard]] static std::unique_ptr<dem::Engine> engine_of(const dem::Setup& setup) {
        Method method;
        method.precision = GetParam();
        return dem::make_engine(setup, method);
    }
    [[nodiscard]] static bool mixed() { return GetParam() == Method::Precision::mixed; }
};
INSTANTIATE_TEST_SUITE_P(Both, Shaking, testing::Values(Method::Precision::mixed, Method::Precision::double_precision),
                         [](const auto& p) { return p.param == Method::Precision::mixed ? "mixed" : "double"; });

constexpr double diameter = 1e-3;

/// A tray of frozen spheres with mobile ones above, shaken obliquely at about 4 g.
dem::Setup tray() {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.cohesion = 5e3;
    s.time_step = 2e-6;
    s.domain = {{-5e-3, -5e-3, -5e-3}, {10e-3, 10e-3, 10e-3}, {}};
    s.shaking = {{30e-6, -20e-6, 40e-6}, 150};
    const stats::Stream stream(3, 1);
    std::uint64_t draw = 0;
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) {
                dem::Sphere p;
                const bool rim = z == 1 && (x == 0 || y == 0 || x == 4 || y == 4);
                p.mobile = z > 0 && !rim;
                const double jitter = p.mobile ? 0.02 * diameter : 0;
                p.position = {x * diameter + jitter * stream.uniform(draw),
                              y * diameter + jitter * stream.uniform(draw + 1), z * 1.01 * diameter};
                draw += 2;
                p.radius = diameter / 2;
                s.spheres.push_back(p);
            }
    return s;
}

dem::State state_of(const dem::Engine& engine) {
    dem::State state;
    engine.state(state);
    return state;
}

TEST_P(Shaking, AFreeSphereKeepsItsParabolaInTheLaboratory) {
    dem::Setup s = tray();
    s.spheres = {{{1e-3, 1e-3, 5e-3}, {0.1, 0, 0.2}, {}, diameter / 2, true}};
    const auto engine = engine_of(s);
    const double w = 2 * std::numbers::pi * s.shaking.frequency;
    for (int block = 0; block < 10; ++block) {
        engine->run(700);
        const double t = s.time_step * 700 * (block + 1);
        const Vec3 x = state_of(*engine).position[0];
        for (std::size_t a = 0; a < 3; ++a) {
            // At the start it moves with the vessel, besides its own velocity in it.
            const double start =
                s.spheres[0].velocity[a] + s.shaking.amplitude[a] / s.time_step * std::sin(w * s.time_step);
            const double fall = s.spheres[0].position[a] + start * t + 0.5 * s.gravity[a] * t * t;
            EXPECT_NEAR(x[a] + s.shaking.amplitude[a] * std::sin(w * t), fall,
                        mixed() ? 1e-7 * diameter * 14000 : 1e-14);
        }
    }
}

TEST_P(Shaking, IsTheSameInTheFrameOfTheLaboratory) {
    const dem::Setup s = tray();
    tests::PlainDem plain(s);
    const auto engine = engine_of(s);
    double lifted = 0;
    for (int block = 0; block < 8; ++block) {
        plain.run(500);
        engine->run(500);
        ASSERT_EQ(engine->fault(), "");
        const dem::State state = state_of(*engine);
        ASSERT_EQ(state.id.size(), s.spheres.size());
        for (std::size_t i = 0; i < s.spheres.size(); ++i) {
            const Vec3 inside = plain.position()[i] - plain.displacement();
            // Both are chaotic: differences of rounding grow tenfold in about 700 steps.
            for (std::size_t a = 0; a < 3; ++a)
                EXPECT_NEAR((state.position[i][a] - inside[a]) / diameter, 0, mixed() ? 1e-3 : 1e-9) << i;
            lifted = std::max(lifted, std::abs(inside[2] - s.spheres[i].position[2]) / diameter);
        }
    }
    EXPECT_GT(lifted, 0.1);
}

TEST_P(Shaking, ACheckpointInTheMiddleOfAPeriodContinuesBitForBit) {
    const dem::Setup s = tray();
    const auto whole = engine_of(s), cut = engine_of(s), restored = engine_of(s);
    whole->run(2000);
    cut->run(777);
    std::vector<std::byte> bytes;
    cut->save(bytes);
    restored->restore(bytes);
    restored->run(2000 - 777);
    const dem::State a = state_of(*whole), b = state_of(*restored);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.angular_velocity, b.angular_velocity);

    dem::Setup other = s;
    other.shaking.amplitude[1] *= 1.001;
    EXPECT_THROW(engine_of(other)->restore(bytes), std::invalid_argument);
}

TEST_P(Shaking, NoAmplitudeIsNoShaking) {
    dem::Setup still = tray(), none = tray();
    still.shaking.amplitude = {};
    none.shaking = {};
    const auto a = engine_of(still), b = engine_of(none);
    a->run(1000);
    b->run(1000);
    EXPECT_EQ(state_of(*a).position, state_of(*b).position);
    EXPECT_EQ(state_of(*a).velocity, state_of(*b).velocity);
}

TEST_P(Shaking, TooFewStepsPerPeriodAreRefused) {
    dem::Setup s = tray();
    s.shaking.frequency = 0.06 / s.time_step;
    EXPECT_THROW(engine_of(s), std::invalid_argument);
}

}  // namespace grainsweep::tests::dem_shaking_test
