// The levels whose particles take space: volume and momentum are conserved to round-off, collisions are those of the
// law, packed cells stay packed, and where a law has nothing to do the level is the simpler one.
#include "solver/coupling/suspension.hpp"
#include "solver/observables/flow_state.hpp"
#include "tests/support/flow_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::coupling_dense_test {

using namespace flow_boxes;

using flow::Boussinesq;

template <class Together>
double fluid_momentum(const Together& together, std::size_t d, int n) {
    double sum = 0;
    const auto& shape = together.fluid().velocity()[d];
    for (int k = 1; k <= n; ++k)
        for (int j = 1; j <= n; ++j)
            for (int i = 1; i <= n; ++i) sum += together.fluid_flux(d, static_cast<std::size_t>(shape.index(i, j, k)));
    return sum / (n * n * n);
}

// phi_p(new) - phi_p(old) = -dt div j in every cell, whatever the particles do: across cells, along walls, over
// periodic sides, on clustered grids, spread or not; and the total is the particles' volume.
TEST(SolidsVolume, IsConservedInEveryCellToRoundOff) {
    const stats::Stream random(4, 4);
    for (const bool open : {false, true})
        for (const double kernel_width : {0.0, 0.15}) {
            const Grid grid = cube(6, open ? 0 : 1.4);
            const flow::Sides& sides = open ? endless : closed;
            SolidsVolume solids(grid, sides, 1e-3, kernel_width);
            std::vector<Vec3> before;
            std::vector<Vec3> after;
            for (std::uint64_t p = 0; p < 200; ++p) {
                Vec3 x;
                Vec3 y;
                for (std::size_t d = 0; d < 3; ++d) {
                    x[d] = random.uniform(6 * p + d) - 0.5;
                    y[d] = x[d] + 0.6 * (random.uniform(6 * p + 3 + d) - 0.5);
                    if (open)
                        y[d] -= std::floor(y[d] + 0.5);
                    else
                        y[d] = std::clamp(y[d], -0.5, 0.5);
                }
                before.push_back(x);
                after.push_back(y);
            }
            const double dt = 1e-3;
            solids.start(before);
            const flow::Field old = solids.fraction();
            solids.place(after);
            solids.carry(dt);
            flow::FaceVectors flux = solids.flux();
            for (int d = 0; d < 3; ++d)
                fill_ghosts(flux[static_cast<std::size_t>(d)], grid, flow::velocity_edges(sides, d));
            double total = 0;
            for (int k = 1; k <= 6; ++k)
                for (int j = 1; j <= 6; ++j)
                    for (int i = 1; i <= 6; ++i) {
                        const double hx = grid[0].width(i);
                        const double hy = grid[1].width(j);
                        const double hz = grid[2].width(k);
                        const double out = (flux[0](i + 1, j, k) - flux[0](i, j, k)) / hx +
                                           (flux[1](i, j + 1, k) - flux[1](i, j, k)) / hy +
                                           (flux[2](i, j, k + 1) - flux[2](i, j, k)) / hz;
                        EXPECT_NEAR(solids.fraction()(i, j, k) - old(i, j, k), -dt * out, 1e-13);
                        total += solids.fraction()(i, j, k) * hx * hy * hz;
                    }
            EXPECT_NEAR(total, 0.2, 1e-12);
        }
}

// Without particles the shared space is the clear fluid: no added term, in a moving flow, on a clustered grid.
TEST(SharedSpace, IsTheClearFluidWithoutParticles) {
    const Grid grid = cube(8, 1.2);
    auto fluid = still_fluid(grid, closed, 3, 1e-4);
    fluid.set_velocity([](double x, double y, double z) {
        return std::array<double, 3>{std::sin(3 * y) * z, std::cos(2 * z) * x, x * y};
    });
    fluid.step();
    flow::SharedSpace space(grid, closed, 3);
    const auto nothing = flow::face_vectors(grid);
    auto excess = nothing;
    space.add_excess(fluid.velocity(), nothing, flow::Field(grid), excess);
    for (std::size_t d = 0; d < 3; ++d)
        for (int k = 1; k <= 8; ++k)
            for (int j = 1; j <= 8; ++j)
                for (int i = 1; i <= 8; ++i) EXPECT_NEAR(excess[d](i, j, k), 0, 1e-10) << d;
}

// A periodic box of fluid and particles, no walls: the fluid's momentum after step n and the particles' before it
// change by the vibrational force on the particles' excess mass alone, to round-off, whatever they do to each other.
template <class Interaction>
void expect_momentum_conserved(double fraction_of_close) {
    const int n = 6;
    const Sphere sphere{2.65, 4e-4, 18, 1e7, 1};
    const auto particles = static_cast<std::size_t>(fraction_of_close / sphere.volume());
    const BoxCase setting{cube(n), endless, sphere, 2e-5, particles};
    const flow::Vibration vibration{1e4, 0.4};
    auto together =
        setting.together<Interaction>(vibration, random_cloud(particles, box(endless, 0), stats::Stream(1, 1)));
    const double weight = sphere.volume() * 1.65 * 1e7 * static_cast<double>(particles);
    const double mass = sphere.density_ratio * sphere.volume();
    double impulse = 0;
    for (int s = 0; s < 12; ++s) {
        impulse += weight * vibration.at((s + 0.5) * setting.dt) * setting.dt;
        Vec3 before{};
        for (const Vec3& v : together.cloud().velocity)
            for (std::size_t d = 0; d < 3; ++d) before[d] += mass * v[d];
        together.step();
        const double scale = weight * setting.dt * (s + 1);
        for (std::size_t d = 0; d < 3; ++d)
            EXPECT_NEAR(fluid_momentum(together, d, n) + before[d], d == 1 ? impulse : 0, 2e-11 * scale)
                << s << ' ' << d;
    }
    EXPECT_LT(together.fluid().largest_divergence(), 1e-7);
}

TEST(DenseSuspension, ConservesMomentumToRoundOff) {
    expect_momentum_conserved<NoInteraction>(0.1);
    expect_momentum_conserved<Ddpm>(0.3);
    expect_momentum_conserved<DdpmKtgf>(0.3);
    expect_momentum_conserved<SpringContacts>(0.05);
    expect_momentum_conserved<ProjectedContacts>(0.2);
}

// With phi_p -> 0 at a given mass loading the level is two-way coupling: the distance falls with phi_p.
TEST(DenseSuspension, BecomesTwoWayWhenItsVolumeVanishes) {
    const int n = 8;
    const auto distance = [&](double stokes, double xi) {
        const Sphere sphere{xi, stokes, 18, 5e7 / xi, 1};
        const std::size_t particles = 300;
        const BoxCase setting{cube(n), closed, sphere, 2e-5, particles};
        const flow::Vibration vibration{1e4, 0};
        const Walls around = box(closed, sphere.radius());
        const auto cloud = random_cloud(particles, around, stats::Stream(2, 1));
        auto dense = setting.together<NoInteraction>(vibration, cloud);
        Suspension<flow::NoHeat, TwoWay, Trilinear, SchillerNaumann> two_way(
            still_fluid(setting.grid, closed, 18, setting.dt), vibration, Motion<SchillerNaumann>(sphere, setting.dt),
            around, cloud, TwoWay(setting.grid, closed, sphere, particles, setting.kernel_width));
        double far = 0;
        double size = 0;
        for (int s = 0; s < 40; ++s) {
            dense.step();
            two_way.step();
        }
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < dense.fluid().velocity()[d].size(); ++m) {
                const double difference =
                    dense.fluid().velocity()[d].values()[m] - two_way.fluid().velocity()[d].values()[m];
                far += difference * difference;
                size += two_way.fluid().velocity()[d].values()[m] * two_way.fluid().velocity()[d].values()[m];
            }
        EXPECT_GT(size, 0);
        return std::sqrt(far / size);
    };
    // A quarter of the volume (a stokes of 4^(-2/3)) at four times the density.
    const double larger = distance(1e-4, 20);
    const double smaller = distance(1e-4 * std::pow(0.25, 2.0 / 3), 80);
    const double smallest = distance(1e-4 * std::pow(1e-3, 2.0 / 3), 2e4);
    EXPECT_LT(larger, 0.5);
    EXPECT_LT(smaller, 0.5 * larger);
    EXPECT_LT(smallest, 2e-3 * larger + 1e-6);
}

// Levels whose law finds nothing to do are the level without it, bit for bit: particles too far apart to meet, cells
// too thin for a stress.
TEST(DenseSuspension, AnIdleLawChangesNoBit) {
    const Sphere sphere{1.65, 3.1e-6, 18, 1e8, 1};
    const flow::Vibration vibration{1.6e4, 0};
    const std::size_t particles = 64;
    Cloud cloud;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                cloud.position.push_back({0.2 * i - 0.3, 0.2 * j - 0.3, 0.2 * k - 0.3});
                cloud.velocity.push_back({});
            }
    BoxCase setting{cube(8), closed, sphere, 1e-5, particles};
    setting.kernel_width = 0.06;
    const auto state = [&]<class Interaction>(Interaction) {
        auto together = setting.together<Interaction>(vibration, cloud);
        for (int s = 0; s < 20; ++s) together.step();
        return together.cloud().position;
    };
    const auto free = state(setting.make<NoInteraction>());
    EXPECT_EQ(state(setting.make<SpringContacts>()), free);
    EXPECT_EQ(state(setting.make<ProjectedContacts>()), free);
    EXPECT_EQ(state(setting.make<Ddpm>()), free);
    EXPECT_EQ(state(setting.make<DdpmKtgf>()), free);
}

// A cloud squeezed into one corner spreads until no cell is over the limit, and stays so under a force that presses.
TEST(SolidsPressure, KeepsThePackingLimit) {
    const Sphere sphere{2.65, 4e-4, 18, 1e6, 1};
    const std::size_t particles = static_cast<std::size_t>(0.12 / sphere.volume());
    const BoxCase setting{cube(6), closed, sphere, 2e-5, particles};
    const stats::Stream random(8, 1);
    Cloud cloud;
    for (std::uint64_t p = 0; p < particles; ++p) {
        cloud.position.push_back({0.2 + 0.25 * random.uniform(3 * p), 0.2 + 0.25 * random.uniform(3 * p + 1),
                                  0.2 + 0.25 * random.uniform(3 * p + 2)});
        cloud.velocity.push_back({});
    }
    SolidsVolume crowded(setting.grid, closed, sphere.volume(), setting.kernel_width);
    crowded.start(cloud.position);
    ASSERT_GT(crowded.largest_fraction(), 2);
    auto together = setting.together<Ddpm>({}, cloud);
    for (int s = 0; s < 60; ++s) {
        together.step();
        ASSERT_LE(together.solids().largest_fraction(), 1.0011 * 0.63) << s;
    }
    EXPECT_GT(together.interaction().limited_steps(), 0);
    for (const Vec3& x : together.cloud().position)
        for (const double c : x) EXPECT_LE(std::abs(c), 0.5 - sphere.radius() + 1e-12);
}

// Solids pressure drives particles from full to empty: a dense layer with a high granular temperature swells.
TEST(SolidsPressure, SpreadsADenseLayer) {
    const Sphere sphere{2.65, 4e-4, 18, 0, 1};
    const std::size_t particles = static_cast<std::size_t>(0.08 / sphere.volume());
    const stats::Stream random(8, 2);
    Cloud cloud;
    for (std::uint64_t p = 0; p < particles; ++p) {
        cloud.position.push_back({0.9 * (random.uniform(3 * p) - 0.5), 0.3 * (random.uniform(3 * p + 1) - 0.5),
                                  0.9 * (random.uniform(3 * p + 2) - 0.5)});
        cloud.velocity.push_back({});
    }
    const auto width = [&](double theta) {
        BoxCase setting{cube(8), closed, sphere, 1e-4, particles};
        setting.granular_temperature = theta;
        auto together = setting.together<Ddpm>({}, cloud);
        for (int s = 0; s < 40; ++s) together.step();
        double sum = 0;
        for (const Vec3& x : together.cloud().position) sum += x[1] * x[1];
        return std::sqrt(sum / static_cast<double>(particles));
    };
    EXPECT_GT(width(1e6), 1.05 * width(0));
}

template <class Interaction>
std::vector<std::byte> dense_state_after(int steps, int cut) {
    const Sphere sphere{1.65, 4e-4, 18, 1e7, 1};
    const std::size_t particles = 150;
    const BoxCase setting{cube(6), closed, sphere, 2e-5, particles};
    const auto make = [&] {
        Boussinesq heat;
        heat.sides[2] = {flow::Isothermal{-0.5}, flow::Isothermal{0.5}};
        heat.buoyancy = -1e6;
        heat.vibration = {1e4, 0};
        Flow<Boussinesq> fluid({setting.grid, closed, 18, setting.dt}, heat);
        fluid.set_temperature([](double, double, double z) { return z; });
        const Walls around = box(closed, sphere.radius());
        return Dense<Interaction, Boussinesq>(
            std::move(fluid), heat.vibration, Motion<SchillerNaumann>(sphere, setting.dt), around,
            random_cloud(particles, around, stats::Stream(5, 1)), setting.make<Interaction>(), setting.kernel_width);
    };
    auto first = make();
    for (int s = 0; s < cut; ++s) first.step();
    std::vector<std::byte> saved;
    first.save(saved);
    auto second = make();
    std::span<const std::byte> from(saved);
    second.restore(from);
    EXPECT_TRUE(from.empty());
    for (int s = cut; s < steps; ++s) second.step();
    std::vector<std::byte> state;
    second.save(state);
    return state;
}

TEST(DenseSuspension, ContinuesBitForBitFromASavedState) {
    EXPECT_EQ(dense_state_after<NoInteraction>(12, 0), dense_state_after<NoInteraction>(12, 7));
    EXPECT_EQ(dense_state_after<Ddpm>(12, 0), dense_state_after<Ddpm>(12, 7));
    EXPECT_EQ(dense_state_after<DdpmKtgf>(12, 0), dense_state_after<DdpmKtgf>(12, 7));
    EXPECT_EQ(dense_state_after<SpringContacts>(12, 0), dense_state_after<SpringContacts>(12, 7));
    EXPECT_EQ(dense_state_after<ProjectedContacts>(12, 0), dense_state_after<ProjectedContacts>(12, 7));
}

}  // namespace grainsweep::tests::coupling_dense_test
