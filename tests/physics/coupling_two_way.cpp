// Two-way coupling: what particles give, the fluid gets.
#include "solver/coupling/drag.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/observables/flow_state.hpp"
#include "tests/support/flow_boxes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace grainsweep::tests::coupling_two_way_test {

using namespace flow_boxes;

using flow::Boussinesq;

template <class Level, class Heat = flow::NoHeat>
using Together = Suspension<Heat, Level, Trilinear, SchillerNaumann>;

// Periodic box, no other force: fluid momentum after step n plus the particles' before it (their inertia is handed
// over one step later) equals the impulse of the vibrational buoyancy, to round-off at every step.
TEST(TwoWay, ConservesMomentumToRoundOff) {
    const Grid grid = cube(8);
    const Sphere sphere{2.65, 1e-4, 18, 1e7, 1};
    const flow::Vibration vibration{1e4, 0.4};
    const double dt = 2e-5;
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {true, true, true}, 0, 1};
    const flow::Sides sides{periodic, periodic, periodic};
    const std::size_t n = 60;
    for (const double kernel_width : {0.0, 0.1}) {
        Together<TwoWay> pair(still_fluid(grid, sides, 18, dt), vibration, Motion<SchillerNaumann>(sphere, dt), box,
                              random_cloud(n, box, stats::Stream(1, 1)), TwoWay(grid, sides, sphere, n, kernel_width));
        const auto fluid_momentum = [&](std::size_t d) {
            double sum = 0;
            for (int k = 1; k <= 8; ++k)
                for (int j = 1; j <= 8; ++j)
                    for (int i = 1; i <= 8; ++i) sum += pair.fluid().velocity()[d](i, j, k) / 512;
            return sum;
        };
        Vec3 before{};
        double impulse = 0;
        const double mass = sphere.density_ratio * sphere.volume();
        for (int s = 0; s < 40; ++s) {
            impulse += n * sphere.volume() * 1.65 * 1e7 * vibration.at((s + 0.5) * dt) * dt;
            before = {};
            for (const Vec3& v : pair.cloud().velocity)
                for (std::size_t d = 0; d < 3; ++d) before[d] += mass * v[d];
            pair.step();
            const double scale = n * sphere.volume() * 1.65 * 1e7 * dt * (s + 1);
            for (std::size_t d = 0; d < 3; ++d)
                EXPECT_NEAR(fluid_momentum(d) + before[d], d == 1 ? impulse : 0, 1e-12 * scale) << s << ' ' << d;
        }
        EXPECT_GT(std::abs(before[1]), 0);
    }
}

// A uniform cloud is a uniform excess density: the pressure carries it and nothing moves, beside walls least of all,
// also where the cells of the grid are unequal. Particles on a lattice, held there by a tiny slip. The same particles
// gathered in one half of the box do stir the fluid.
TEST(TwoWay, AUniformCloudMovesNothing) {
    const int n = 10;
    const flow::Sides sides{walls, walls, walls};
    const Sphere sphere{2.65, 3.1e-6, 18, 1e6, 1};
    const double dt = 1e-6;
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, 0, 1};
    const auto speed = [&](double clustering, int m, double squeeze, Hats hats) {
        const Grid grid = cube(n, clustering);
        Cloud cloud;
        for (int k = 0; k < m; ++k)
            for (int j = 0; j < m; ++j)
                for (int i = 0; i < m; ++i) {
                    const double z = (k + 0.5) / m - 0.5;
                    cloud.position.push_back(
                        {(i + 0.5) / m - 0.5, (j + 0.5) / m - 0.5, squeeze < 1 ? z * squeeze - 0.2 : z});
                    cloud.velocity.push_back({});
                }
        Together<TwoWay> pair(still_fluid(grid, sides, 18, dt), {}, Motion<SchillerNaumann>(sphere, dt), box, cloud,
                              TwoWay(grid, sides, sphere, cloud.size(), 0.1, hats));
        for (int s = 0; s < 10; ++s) pair.step();
        return observables::peak_velocity(grid, pair.fluid().velocity());
    };
    EXPECT_LT(speed(0, 2 * n, 1, Hats::linear), 1e-2 * speed(0, 2 * n, 0.5, Hats::linear));
    const int fine = 48;  // as fine as it takes for a lattice to be uniform on these cells
    const double even = speed(1.5, fine, 1, Hats::linear);
    const double not_levelled = speed(1.5, fine, 1, Hats::metric);
    const double stirred = speed(1.5, fine, 0.5, Hats::linear);
    std::printf("clustered: %.3g, without levelling %.3g, stirred %.3g\n", even, not_levelled, stirred);
    EXPECT_LT(even, 1e-2 * stirred);
    EXPECT_LT(even, 0.2 * not_levelled);
}

// A steady point force in a periodic box: the Stokeslet of the kernel's Gaussian (Hasimoto 1959, doi
// 10.1017/S0022112059000222, for a point),
//   u(x) = F/nu sum over k != 0 of (e - k (k.e)/k^2)/k^2 exp(-k^2 w^2/2) cos(k.(x - X)),
// far from the particle as at its place, where it is what the particle feels of itself.
TEST(TwoWay, APointForceIsAStokeslet) {
    const int n = 32;
    const Grid grid = cube(n);
    const flow::Sides sides{periodic, periodic, periodic};
    const double width = 0.08;
    const Vec3 x{0.013, -0.021, 0.007};
    auto fluid = still_fluid(grid, sides, 1, 1e-3);
    FaceDeposit deposit(grid, sides, width);
    flow::FaceVectors force = flow::face_vectors(grid);
    Stencil<Trilinear>(grid, {true, true, true}, x).scatter({0, 1, 0}, force);
    deposit.spread(force);
    for (int s = 0; s < 300; ++s) fluid.step(force);  // the slowest mode decays as exp(-4 pi^2 t)
    const double drift = fluid.time();                // of the whole box, which nothing holds
    const auto exact = [&](const Vec3& at) {
        constexpr double pi = std::numbers::pi;
        Vec3 u{};
        const int modes = 10;
        for (int a = -modes; a <= modes; ++a)
            for (int b = -modes; b <= modes; ++b)
                for (int c = -modes; c <= modes; ++c) {
                    if (a == 0 && b == 0 && c == 0) continue;
                    const Vec3 k{2 * pi * a, 2 * pi * b, 2 * pi * c};
                    const double square = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
                    const double phase = k[0] * (at[0] - x[0]) + k[1] * (at[1] - x[1]) + k[2] * (at[2] - x[2]);
                    const double amplitude = std::exp(-0.5 * square * width * width) / square * std::cos(phase);
                    for (std::size_t d = 0; d < 3; ++d) u[d] += ((d == 1 ? 1 : 0) - k[d] * k[1] / square) * amplitude;
                }
        return u;
    };
    const double self = exact(x)[1];
    // Alone in infinite space less what its images take away, 2.8373/(6 pi nu L) for points (Hasimoto).
    constexpr double pi = std::numbers::pi;
    EXPECT_NEAR(self, 1 / (3 * std::pow(pi, 1.5) * std::sqrt(2.0) * width) - 2.8373 / (6 * pi), 0.01 * self);
    for (const Vec3& apart : {Vec3{}, Vec3{0, 0.12, 0}, Vec3{0.12, 0, 0}, Vec3{0.1, 0.1, 0}, Vec3{0.2, 0.1, -0.15}}) {
        const Vec3 at{x[0] + apart[0], x[1] + apart[1], x[2] + apart[2]};
        const Vec3 found = Stencil<Trilinear>(grid, {true, true, true}, at).gather(fluid.velocity());
        const Vec3 expected = exact(at);
        for (std::size_t d = 0; d < 3; ++d)
            EXPECT_NEAR(found[d] - (d == 1 ? drift : 0), expected[d], 0.02 * self) << apart[0] << ' ' << apart[1];
    }
}

// A layer of dilute cloud answers the vibration as a layer of cold fluid with the same excess density,
// (xi - 1) phi gamma = -B theta; particle inertia adds xi phi, a per mille here.
TEST(TwoWay, ACloudLayerMovesAsAHeavyFluidLayer) {
    const int n = 12;
    const Grid grid = cube(n);
    const flow::Sides sides{walls, walls, walls};
    const Sphere sphere{2.65, 3.1e-6, 18, 1e6, 1};
    const double dt = 1e-5;
    const flow::Vibration vibration{2e3, 0};
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, 0, 1};
    // Two layers of cells, 8 particles in each cell.
    Cloud cloud;
    for (int k = 10; k < 14; ++k)
        for (int j = 0; j < 2 * n; ++j)
            for (int i = 0; i < 2 * n; ++i) {
                cloud.position.push_back(
                    {(i + 0.5) / (2 * n) - 0.5, (j + 0.5) / (2 * n) - 0.5, (k + 0.5) / (2 * n) - 0.5});
                cloud.velocity.push_back({});
            }
    const double phi = 8 * sphere.volume() * n * n * n;
    Together<TwoWay> pair(still_fluid(grid, sides, 18, dt), vibration, Motion<SchillerNaumann>(sphere, dt), box, cloud,
                          TwoWay(grid, sides, sphere, cloud.size(), 0));
    Boussinesq heat;
    heat.diffusivity = 0;
    heat.buoyancy = -1;
    heat.vibration = vibration;
    Flow<Boussinesq> layered({grid, sides, 18, dt}, heat);
    // Trilinear deposition along z of particles at a quarter and three quarters of a cell.
    const std::array<double, 4> share{0.125, 0.875, 0.875, 0.125};
    layered.set_temperature([&](double, double, double z) {
        const int k = static_cast<int>((z + 0.5) * n);
        return k >= 4 && k <= 7 ? -1.65 * 1e6 * phi * share[static_cast<std::size_t>(k - 4)] : 0.0;
    });
    double largest = 0;
    for (int s = 0; s < 60; ++s) {
        pair.step();
        layered.step();
        const double heavy = observables::peak_velocity(grid, pair.fluid().velocity());
        const double cold = observables::peak_velocity(grid, layered.velocity());
        largest = std::max(largest, cold);
        if (s >= 10) {
            EXPECT_NEAR(heavy, cold, 0.03 * largest) << s;
        }
    }
    EXPECT_GT(largest, 0.1);
}

template <class Level>
std::vector<std::byte> state_after(int steps, int cut) {
    const Grid grid = cube(6);
    const flow::Sides sides{walls, walls, walls};
    const Sphere sphere{1.65, 3.1e-5, 18, 1e8, 1};
    const double dt = 1e-5;
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, sphere.radius(), 1};
    const auto make = [&] {
        Boussinesq heat;
        heat.sides[2] = {flow::Isothermal{-0.5}, flow::Isothermal{0.5}};
        heat.buoyancy = -1e6;
        heat.vibration = {1e4, 0};
        Flow<Boussinesq> fluid({grid, sides, 18, dt}, heat);
        fluid.set_temperature([](double, double, double z) { return z; });
        return Together<Level, Boussinesq>(std::move(fluid), heat.vibration, Motion<SchillerNaumann>(sphere, dt), box,
                                           random_cloud(50, box, stats::Stream(5, 1)), [&] {
                                               if constexpr (requires { Level::subtracts_own_wake; })
                                                   return Level(grid, sides, sphere, 50, 0.1, dt);
                                               else if constexpr (Level::acts_on_fluid)
                                                   return Level(grid, sides, sphere, 50, 0.1);
                                               else
                                                   return Level{};
                                           }());
    };
    auto first = make();
    for (int s = 0; s < cut; ++s) first.step();
    std::vector<std::byte> saved;
    first.save(saved);
    auto second = make();
    std::span<const std::byte> from(saved);
    second.restore(from);
    for (int s = cut; s < steps; ++s) second.step();
    std::vector<std::byte> state;
    second.save(state);
    return state;
}

TEST(Suspension, ContinuesBitForBitFromASavedState) {
    EXPECT_EQ(state_after<OneWay>(12, 0), state_after<OneWay>(12, 7));
    EXPECT_EQ(state_after<TwoWay>(12, 0), state_after<TwoWay>(12, 7));
    EXPECT_EQ(state_after<TwoWayWithoutOwnWake>(12, 0), state_after<TwoWayWithoutOwnWake>(12, 7));
}

}  // namespace grainsweep::tests::coupling_two_way_test
