// The levels whose particles take space: volume and momentum are conserved to round-off, collisions are those of the
// law, packed cells stay packed, and where a law has nothing to do the level is the simpler one.
#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/drag.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/observables/flow_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace grainsweep;
using namespace grainsweep::coupling;
using flow::Axis;
using flow::Boussinesq;
using flow::Flow;
using flow::Grid;

namespace {

constexpr std::array<flow::Side, 2> walls{flow::NoSlip{}, flow::NoSlip{}};
constexpr std::array<flow::Side, 2> periodic{flow::Periodic{}, flow::Periodic{}};
const flow::Sides closed{walls, walls, walls};
const flow::Sides endless{periodic, periodic, periodic};

Grid cube(int n, double clustering = 0) {
    const Axis axis = clustering > 0 ? Axis::clustered(n, -0.5, 0.5, clustering) : Axis::uniform(n, -0.5, 0.5);
    return {{axis, axis, axis}};
}

Walls box(const flow::Sides& sides, double contact) {
    const bool open = std::holds_alternative<flow::Periodic>(sides[0][0]);
    return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {open, open, open}, contact, 1};
}

Flow<flow::NoHeat> still_fluid(const Grid& grid, const flow::Sides& sides, double viscosity, double dt) {
    return {{grid, sides, viscosity, dt}, flow::NoHeat{}};
}

template <class Interaction, class Heat = flow::NoHeat>
using Dense = DenseSuspension<Heat, Interaction, Trilinear, SchillerNaumann>;

using Ddpm = SolidsPressure<AlgebraicTemperature>;
using DdpmKtgf = SolidsPressure<TransportedTemperature>;

// Every interaction with the same arguments.
struct Setting {
    Grid grid;
    flow::Sides sides;
    Sphere sphere;
    double dt;
    std::size_t particles;
    double collision = 0.8;
    double granular_temperature = 1;
    int smoothing = 1;
    double friction = 0.3;

    template <class Interaction>
    [[nodiscard]] Interaction make() const {
        const Walls around = box(sides, sphere.radius());
        if constexpr (std::is_same_v<Interaction, SpringContacts>)
            return {sphere, around, {SpringContacts::stiffness(sphere, 0.01, dt), collision, friction}, particles};
        else if constexpr (std::is_same_v<Interaction, ProjectedContacts>)
            return {sphere, around, dt};
        else if constexpr (std::is_same_v<Interaction, NoInteraction>)
            return {};
        else
            return {grid, sides, sphere, Granular::of(sphere, collision, 0.63), granular_temperature, smoothing};
    }
    template <class Interaction>
    [[nodiscard]] Dense<Interaction> together(const flow::Vibration& vibration, const Cloud& cloud) const {
        return {still_fluid(grid, sides, sphere.prandtl, dt),
                vibration,
                Motion<SchillerNaumann>(sphere, dt),
                box(sides, sphere.radius()),
                cloud,
                make<Interaction>(),
                smoothing};
    }
};

template <class Together>
double fluid_momentum(const Together& together, std::size_t d, int n) {
    double sum = 0;
    const auto& shape = together.fluid().velocity()[d];
    for (int k = 1; k <= n; ++k)
        for (int j = 1; j <= n; ++j)
            for (int i = 1; i <= n; ++i) sum += together.fluid_flux(d, static_cast<std::size_t>(shape.index(i, j, k)));
    return sum / (n * n * n);
}

}  // namespace

// phi_p(new) - phi_p(old) = -dt div j in every cell, whatever the particles do: across cells, along walls, over
// periodic sides, on clustered grids, smoothed or not; and the total is the particles' volume.
TEST(SolidsVolume, IsConservedInEveryCellToRoundOff) {
    const stats::Stream random(4, 4);
    for (const bool open : {false, true})
        for (const int passes : {0, 2}) {
            const Grid grid = cube(6, open ? 0 : 1.4);
            const flow::Sides& sides = open ? endless : closed;
            SolidsVolume solids(grid, sides, 1e-3, passes);
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
            solids.place(before);
            const flow::Field old = solids.fraction();
            solids.carry(before, after, dt);
            solids.place(after);
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
    const Setting setting{cube(n), endless, sphere, 2e-5, particles};
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
        Setting setting{cube(n), closed, sphere, 2e-5, particles};
        const flow::Vibration vibration{1e4, 0};
        const Walls around = box(closed, sphere.radius());
        const auto cloud = random_cloud(particles, around, stats::Stream(2, 1));
        setting.smoothing = 2;
        auto dense = setting.together<NoInteraction>(vibration, cloud);
        Suspension<flow::NoHeat, TwoWay<ForceForm>, Trilinear, SchillerNaumann> two_way(
            still_fluid(setting.grid, closed, 18, setting.dt), vibration, Motion<SchillerNaumann>(sphere, setting.dt),
            around, cloud, TwoWay<ForceForm>(setting.grid, closed, sphere, particles, 2));
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
    const Setting setting{cube(8), closed, sphere, 1e-5, particles};
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

namespace {

// Two spheres flying at each other through almost no fluid; what they do to it is not looked at.
struct Collision {
    Vec3 after_i{}, after_j{};
};
struct Nothing {
    Vec3 spin{};
    Surroundings operator()(std::size_t) const { return {}; }
    [[nodiscard]] Vec3 rotation(std::size_t) const { return spin; }
};

Collision collide(double restitution, double speed, double offset, double friction) {
    const Sphere sphere{4, 1e-4, 1e-9, 0, 1};
    const double dt = 1e-3;
    const Walls around = box(closed, sphere.radius());
    const double mass = 4.5 * sphere.volume();
    // A contact of a hundred sub-steps and five steps.
    HystereticSpring spring{mass * 1e6, restitution, friction};
    SpringContacts contacts(sphere, around, spring, 2);
    Cloud cloud;
    const double r = sphere.radius();
    cloud.position = {{-1.2 * r, 0, 0}, {1.2 * r, offset, 0}};
    cloud.velocity = {{speed, 0, 0}, {-speed, 0, 0}};
    const Grid grid = cube(4);
    SolidsVolume solids(grid, closed, sphere.volume(), 0);
    std::vector<Vec3> handed(2);
    const Motion<StokesDrag> motion(sphere, dt);
    const int steps = static_cast<int>(1.6 * r / speed / dt) + 20;
    Collision found;
    for (int s = 0; s < steps; ++s) {
        contacts.move(cloud, motion, around, solids, 0, Nothing{}, handed);
    }
    found.after_i = cloud.velocity[0];
    found.after_j = cloud.velocity[1];
    return found;
}

}  // namespace

// Head-on in vacuum: v' = -e v, whatever the speed; momentum untouched.
TEST(SpringContacts, ReturnTheRestitutionOfTheirLaw) {
    for (const double e : {0.3, 0.6, 0.9, 1.0})
        for (const double speed : {0.01, 1.0}) {
            const auto found = collide(e, speed, 0, 0.3);
            EXPECT_NEAR(found.after_i[0], -e * speed, 5e-3 * speed) << e << ' ' << speed;
            EXPECT_NEAR(found.after_j[0], e * speed, 5e-3 * speed) << e << ' ' << speed;
            EXPECT_NEAR(found.after_i[0] + found.after_j[0], 0, 1e-9 * speed);
            EXPECT_NEAR(found.after_i[1], 0, 1e-12);
        }
}

// A grazing collision with friction turns both spheres the same way and keeps momentum and angular momentum.
TEST(SpringContacts, FrictionConservesAngularMomentum) {
    const Sphere sphere{4, 1e-4, 1e-9, 0, 1};
    const double r = sphere.radius();
    const Walls around = box(closed, r);
    SpringContacts contacts(sphere, around, {4.5 * sphere.volume() * 1e6, 0.7, 0.3}, 2);
    Cloud cloud;
    cloud.position = {{-1.2 * r, 0, 0}, {1.2 * r, r, 0}};
    cloud.velocity = {{1, 0, 0}, {-1, 0, 0}};
    const Grid grid = cube(4);
    SolidsVolume solids(grid, closed, sphere.volume(), 0);
    std::vector<Vec3> handed(2);
    const Motion<StokesDrag> motion(sphere, 1e-3);
    const double mass = 4.5 * sphere.volume();
    const double inertia = 0.4 * 4 * sphere.volume() * r * r;
    const auto angular = [&] {
        double sum = 0;
        for (std::size_t p = 0; p < 2; ++p)
            sum += mass * (cloud.position[p][0] * cloud.velocity[p][1] - cloud.position[p][1] * cloud.velocity[p][0]) +
                   inertia * contacts.spins()[p][2];
        return sum;
    };
    const double before = angular();
    const double speed_before = cloud.velocity[0][0];
    for (int s = 0; s < 120; ++s) contacts.move(cloud, motion, around, solids, 0, Nothing{}, handed);
    EXPECT_NE(cloud.velocity[0][0], speed_before);
    EXPECT_GT(std::abs(contacts.spins()[0][2]), 1);
    EXPECT_NEAR(contacts.spins()[0][2], contacts.spins()[1][2], 1e-9 * std::abs(contacts.spins()[0][2]));
    EXPECT_NEAR(cloud.velocity[0][1] + cloud.velocity[1][1], 0, 1e-12);
    // The contact point lies half an overlap inside both spheres, whose torques are taken at the radius: the error of
    // soft spheres, of the size overlap/diameter.
    EXPECT_NEAR(angular(), before, 0.02 * std::abs(before));
}

// Dense particles that vibrate against a wall rest on it with the overlap asked for, and the fluid does not feel the
// force that the wall takes.
TEST(SpringContacts, AParticlePressedToAWallRestsThere) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e8, 1};
    const double r = sphere.radius();
    const Setting setting{cube(6), closed, sphere, 1e-5, 1};
    Cloud cloud;
    cloud.position = {{0, 0.5 - 1.02 * r, 0}};
    cloud.velocity = {{}};
    auto together = setting.together<SpringContacts>({}, cloud);  // a steady force towards +y
    for (int s = 0; s < 400; ++s) together.step();
    const double overlap = together.cloud().position[0][1] - (0.5 - r);
    const double force = 2.49 * 1.09e8 * sphere.volume();
    EXPECT_GT(overlap, 0.99 * force / SpringContacts::stiffness(sphere, 0.01, setting.dt));
    EXPECT_LT(overlap, 0.0105 * 2 * r);
    EXPECT_NEAR(together.cloud().velocity[0][1], 0, 1e-3);
    const double fluid = observables::peak_velocity(setting.grid, together.fluid().velocity());
    // Released in the middle it drives the fluid for as long as it falls.
    cloud.position = {{0, -0.2, 0}};
    auto falling = setting.together<SpringContacts>({}, cloud);
    for (int s = 0; s < 20; ++s) falling.step();
    EXPECT_LT(fluid, 0.05 * observables::peak_velocity(setting.grid, falling.fluid().velocity()));
}

// A cloud pressed to a wall by a steady force: springs without friction and displacement end in the same layer, and
// neither leaves overlaps.
TEST(ProjectedContacts, PressACloudToAWallAsSpringsDo) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e6, 1};
    const double r = sphere.radius();
    const std::size_t particles = 60;
    Setting setting{cube(6), closed, sphere, 2e-4, particles};
    setting.friction = 0;
    const auto cloud = random_cloud(particles, box(closed, r), stats::Stream(6, 1));
    const auto pressed = [&]<class Interaction>(Interaction) {
        auto together = setting.together<Interaction>({}, cloud);
        for (int s = 0; s < 200; ++s) together.step();
        auto positions = together.cloud().position;
        double mean = 0;
        double overlap = 0;
        for (std::size_t p = 0; p < particles; ++p) {
            mean += positions[p][1] / static_cast<double>(particles);
            overlap = std::max(overlap, positions[p][1] - (0.5 - r));
            for (std::size_t q = 0; q < p; ++q) {
                double square = 0;
                for (std::size_t d = 0; d < 3; ++d) square += std::pow(positions[p][d] - positions[q][d], 2);
                overlap = std::max(overlap, 2 * r - std::sqrt(square));
            }
        }
        EXPECT_LT(overlap, 0.05 * 2 * r);
        return mean;
    };
    const double soft = pressed(setting.make<SpringContacts>());
    const double hard = pressed(setting.make<ProjectedContacts>());
    EXPECT_GT(hard, 0.5 - 3 * r);
    EXPECT_NEAR(soft, hard, 0.3 * r);
}

// A cloud squeezed into one corner spreads until no cell is over the limit, and stays so under a force that presses.
TEST(SolidsPressure, KeepsThePackingLimit) {
    const Sphere sphere{2.65, 4e-4, 18, 1e6, 1};
    const std::size_t particles = static_cast<std::size_t>(0.12 / sphere.volume());
    const Setting setting{cube(6), closed, sphere, 2e-5, particles};
    const stats::Stream random(8, 1);
    Cloud cloud;
    for (std::uint64_t p = 0; p < particles; ++p) {
        cloud.position.push_back({0.2 + 0.25 * random.uniform(3 * p), 0.2 + 0.25 * random.uniform(3 * p + 1),
                                  0.2 + 0.25 * random.uniform(3 * p + 2)});
        cloud.velocity.push_back({});
    }
    SolidsVolume crowded(setting.grid, closed, sphere.volume(), 1);
    crowded.place(cloud.position);
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
        Setting setting{cube(8), closed, sphere, 1e-4, particles};
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
    const Setting setting{cube(6), closed, sphere, 2e-5, particles};
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
            random_cloud(particles, around, stats::Stream(5, 1)), setting.make<Interaction>(), 1);
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
