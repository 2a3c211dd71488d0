// What many spheres do together, against laws of granular matter and another program's statistics.
//
//   orifice   Beverloo, Leniger & van de Velde (1961), Chem. Eng. Sci. 15, 260: W = C rho_b sqrt(g) (D - k d)^(5/2),
//             C 0.55 to 0.65 and k 1.2 to 1.6 for spheres and sharp edges
//   heap      the angle of repose grows with friction
//   chute     mean velocity, kinetic energy and coordination of a flow down 26 degrees, against LIGGGHTS 3.8
#include "solver/dem/engine.hpp"
#include "solver/dem/time_step.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_beds.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/peer_programs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::tests::dem_granular_test {

constexpr double d = 2e-3, gravity = 9.81;

dem::Method mixed() {
    dem::Method m;
    m.precision = dem::Method::Precision::mixed;
    return m;
}

dem::Setup soft_powder() {
    dem::Setup s;
    s.material = tests::steel_like();
    s.material.youngs_modulus = 2e6;  // overlaps below 1 %: flow does not feel it
    s.material.friction = 0.5;
    s.gravity = {0, 0, -gravity};
    s.time_step = 0.2 * dem::rayleigh_time(s.material, d / 2);
    return s;
}

/// Spheres on a jittered lattice over [0, lx] x [0, ly] x [0, lz].
void fill(dem::Setup& s, double lx, double ly, double lz, std::uint64_t seed) {
    const double pitch = 1.1 * d;
    const stats::Stream stream(seed, 4);
    std::uint64_t draw = 0;
    const auto u = [&] { return 0.04 * d * (2 * stream.uniform(draw++) - 1); };
    for (double z = 0.6 * d; z < lz; z += pitch)
        for (double y = 0.55 * d; y + 0.5 * d < ly; y += pitch)
            for (double x = 0.55 * d; x + 0.5 * d < lx; x += pitch)
                s.spheres.push_back({{x + u(), y + u(), z + u()}, {u() / d, u() / d, 0}, {}, d / 2, true});
}

/// A deep periodic bed at rest on a plate at z = 0.
struct Bed {
    static constexpr double side = 18 * d, height = 30 * d;
    dem::State state;
    double bulk = 0;  ///< spheres per volume
};

Bed deep_bed() {
    dem::Setup s = soft_powder();
    s.domain = {{0, 0, -10 * d}, {Bed::side, Bed::side, 60 * d}, {true, true, false}};
    s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    fill(s, Bed::side, Bed::side, Bed::height, 1);
    const auto engine = dem::make_engine(s, mixed());
    engine->run(std::llround(0.25 / s.time_step));
    EXPECT_EQ(engine->fault(), "");
    Bed bed;
    engine->state(bed.state);
    for (const auto& x : bed.state.position)
        bed.bulk += x[2] > 2 * d && x[2] < 12 * d ? 1 / (Bed::side * Bed::side * 10 * d) : 0;
    return bed;
}

/// Spheres per second through a hole of diameter `hole` in a plate of frozen spheres under the bed, while `wanted` of
/// them pass: a count whose scatter is a few per cent.
double discharge(const Bed& bed, double hole, std::size_t wanted) {
    dem::Setup s = soft_powder();
    constexpr double side = Bed::side;
    s.domain = {{0, 0, -10 * d}, {side, side, 60 * d}, {true, true, false}};
    const int n = static_cast<int>(side / (0.9 * d));
    for (int i = 0; i < n; ++i)  // the plate, its top at z = 0
        for (int j = 0; j < n; ++j) {
            const double x = (i + 0.5) * side / n, y = (j + 0.5) * side / n;
            if (std::hypot(x - side / 2, y - side / 2) > hole / 2 + 0.9 * d)
                s.spheres.push_back({{x, y, -d / 2}, {}, {}, d / 2, false});
        }
    const double rim = hole / 2 + d / 2;
    const int around = static_cast<int>(2 * std::numbers::pi * rim / (0.4 * d));
    for (int k = 0; k < around; ++k) {  // so close that the hole is round to 1 % of d
        const double angle = 2 * std::numbers::pi * k / around;
        s.spheres.push_back(
            {{side / 2 + rim * std::cos(angle), side / 2 + rim * std::sin(angle), -d / 2}, {}, {}, d / 2, false});
    }
    for (std::size_t i = 0; i < bed.state.id.size(); ++i)
        s.spheres.push_back({bed.state.position[i], bed.state.velocity[i], bed.state.angular_velocity[i], d / 2, true});
    const auto engine = dem::make_engine(s, mixed());
    engine->run(std::llround(0.1 / s.time_step));  // until the flow is steady
    const auto before = engine->size();
    const auto block = std::llround(0.02 / s.time_step);
    int blocks = 0;
    for (; before - engine->size() < wanted && blocks < 150; ++blocks) engine->run(block);
    EXPECT_EQ(engine->fault(), "");
    EXPECT_GE(before - engine->size(), wanted) << "the hole is blocked";
    return static_cast<double>(before - engine->size()) / (blocks * static_cast<double>(block) * s.time_step);
}

/// Slope of what stays on a rough base of finite length after all that could slid off its ends, degrees.
double repose(double friction, std::uint64_t seed) {
    dem::Setup s = soft_powder();
    s.material.friction = friction;
    constexpr double length = 50 * d, width = 5 * d;
    s.domain = {{-5 * d, 0, -5 * d}, {length + 5 * d, width, 40 * d}, {false, true, false}};
    fill(s, length, width, 14 * d, seed);
    for (int i = 0; i < 50; ++i)
        for (int j = 0; j < 5; ++j) s.spheres.push_back({{(i + 0.5) * d, (j + 0.5) * d, -d / 2}, {}, {}, d / 2, false});
    const auto engine = dem::make_engine(s, mixed());
    engine->run(std::llround(1.2 / s.time_step));
    EXPECT_EQ(engine->fault(), "");
    dem::State state;
    engine->state(state);
    constexpr std::size_t columns = 25;
    std::vector<double> top(columns, 0.0);
    for (std::size_t i = 0; i < state.id.size(); ++i) {
        const double x = state.position[i][0];
        if (x < 0 || x >= length) continue;
        double& height = top[static_cast<std::size_t>(x / length * columns)];
        height = std::max(height, state.position[i][2]);
    }
    // least squares over both flanks folded together, the ends and the rounded summit left out
    double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
    for (std::size_t c = 2; c < columns - 2; ++c) {
        const double x =
            std::min(static_cast<double>(c) + 0.5, columns - (static_cast<double>(c) + 0.5)) * length / columns;
        if (x > 0.4 * length) continue;
        ++n, sx += x, sz += top[c], sxx += x * x, sxz += x * top[c];
    }
    return std::atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180 / std::numbers::pi;
}

struct Mean {
    double sum = 0, square = 0;
    int n = 0;
    void add(double x) { sum += x, square += x * x, ++n; }
    [[nodiscard]] double value() const { return sum / n; }
    [[nodiscard]] double error() const { return std::sqrt((square - sum * sum / n) / (n - 1) / n); }
};

TEST(DemGranular, AnOrificeDischargesAsBeverlooFound) {
    std::vector<double> holes, roots;
    const Bed bed = deep_bed();
    const double scale = bed.bulk * std::sqrt(gravity) * std::pow(d, 2.5);
    for (const double hole : {4.5, 5.5, 6.75, 8.0}) {
        const double rate = discharge(bed, hole * d, 1200);
        // In the middle of the published constants. Those are of sharp edges; this one is round.
        EXPECT_NEAR(rate / (0.58 * scale * std::pow(hole - 1.4, 2.5)), 1, 0.25) << hole;
        holes.push_back(hole);
        roots.push_back(std::pow(rate, 0.4));
    }
    // rate^(2/5) is a straight line over the hole's diameter, crossing zero at k d
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const auto n = static_cast<double>(holes.size());
    for (std::size_t i = 0; i < holes.size(); ++i)
        sx += holes[i], sy += roots[i], sxx += holes[i] * holes[i], sxy += holes[i] * roots[i];
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), offset = (sy - slope * sx) / n;
    const double k = -offset / slope;
    const double factor = std::pow(slope, 2.5) / scale;
    std::printf("Beverloo: C = %.3f, k = %.2f, bulk fraction %.3f\n", factor, k,
                bed.bulk * std::numbers::pi / 6 * d * d * d);
    for (std::size_t i = 0; i < holes.size(); ++i)
        EXPECT_NEAR(roots[i], offset + slope * holes[i], 0.015 * roots[i]) << holes[i];
    EXPECT_GT(k, 0.5);  // a centre cannot pass closer to the edge than half a diameter
    EXPECT_LT(k, 2);
}

TEST(DemGranular, TheAngleOfReposeGrowsWithFriction) {
    std::vector<Mean> angles;
    for (const double friction : {0.05, 0.2, 0.6}) {
        Mean angle;
        for (std::uint64_t seed = 1; seed <= 3; ++seed) angle.add(repose(friction, seed));
        std::printf("angle of repose at friction %g: %.1f +- %.1f degrees\n", friction, angle.value(), angle.error());
        angles.push_back(angle);
    }
    EXPECT_GT(angles[1].value(), angles[0].value() + 2 * std::hypot(angles[0].error(), angles[1].error()));
    EXPECT_GT(angles[2].value(), angles[1].value());
    EXPECT_LT(angles[2].value(), 40);
}

TEST(DemGranular, AChuteFlowsAsInLiggghts) {
    // LIGGGHTS 3.8 from the same four starts (bench_peers --scene chute_statistics): after so many collisions single
    // particles have nothing in common any more, so the means must agree within three standard errors.
    constexpr std::array energies = {2.1254e-11, 2.337e-11, 1.9747e-11, 2.72e-11};  // J
    constexpr std::array velocities = {0.0086279, 0.0087529, 0.0080644, 0.010105};  // m/s
    constexpr std::array contacts = {2.6244, 2.7584, 2.7098, 2.7033};               // per mobile particle
    Mean energy, velocity, coordination, their_energy, their_velocity, their_coordination;
    for (std::uint64_t seed = 1; seed <= 7; ++seed) {  // further starts for a smaller error of our means
        const dem::Setup setup = tests::small_chute(seed);
        const auto engine = dem::make_engine(setup, mixed());
        engine->run(std::llround(tests::small_chute_time / setup.time_step));
        EXPECT_EQ(engine->fault(), "");
        dem::State state;
        engine->state(state);
        const auto figures = tests::figures_of(state, setup);
        energy.add(figures.kinetic_energy), velocity.add(figures.velocity_x), coordination.add(figures.coordination);
        if (seed > energies.size()) continue;
        their_energy.add(energies[seed - 1]), their_velocity.add(velocities[seed - 1]);
        their_coordination.add(contacts[seed - 1]);
    }
    const auto equal = [](const Mean& a, const Mean& b, const char* what) {
        EXPECT_NEAR(a.value(), b.value(), 3 * std::hypot(a.error(), b.error())) << what;
        EXPECT_LT(a.error(), 0.1 * a.value()) << what << ": too much scatter to tell anything";
    };
    equal(energy, their_energy, "kinetic energy");
    equal(velocity, their_velocity, "mean velocity");
    equal(coordination, their_coordination, "coordination");
}

}  // namespace grainsweep::tests::dem_granular_test
