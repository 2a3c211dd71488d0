// Adhesion by surface energy (solver/dem/laws/jkr.hpp, dmt.hpp) against closed forms, in both engines.
#include "solver/dem/engine.hpp"
#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::dem_adhesion_test {

using dem::CohesionLaw;
using dem::Method;
using dem::Vec3;
using std::numbers::pi;

constexpr double radius = 15e-6;

/// 30 um steel-like spheres, softened.
dem::Material powder(CohesionLaw law, double surface_energy) {
    dem::Material m;
    m.youngs_modulus = 50e6;
    m.poisson_ratio = 0.3;
    m.density = 7800;
    m.restitution = 1;
    m.friction = 0;
    m.cohesion_law = law;
    m.surface_energy = surface_energy;
    return m;
}

dem::Setup pair_of(const dem::Material& material, double gap, double speed, double time_step) {
    dem::Setup s;
    s.domain = {{-1e-4, -1e-4, -1e-4}, {1e-4, 1e-4, 1e-4}, {}};  // in mixed precision a position counts 1e-13 m
    s.gravity = {};
    s.material = material;
    s.time_step = time_step;
    s.spheres = {{{-radius - gap / 2, 0, 0}, {speed / 2, 0, 0}, {}, radius, true},
                 {{radius + gap / 2, 0, 0}, {-speed / 2, 0, 0}, {}, radius, true}};
    return s;
}

constexpr Method::Precision both[] = {Method::Precision::double_precision, Method::Precision::mixed};

/// The largest root a of the quartic, by bisection of d(a) = a^2/R* - sqrt(2 pi w a/E*), which grows beyond its
/// minimum.
double contact_radius(const dem::Material& m, double effective, double overlap) {
    const double modulus = dem::effective_modulus(m), w = m.surface_energy;
    const auto at = [&](double a) { return a * a / effective - std::sqrt(2 * pi * w * a / modulus); };
    double low = std::cbrt(pi * w * effective * effective / (8 * modulus)), high = 100 * effective;  // low: d'(a) = 0
    for (int k = 0; k < 200; ++k) (at((low + high) / 2) < overlap ? low : high) = (low + high) / 2;
    return (low + high) / 2;
}

double force(const dem::Material& m, double effective, double a) {
    const double modulus = dem::effective_modulus(m);
    return 4 * modulus * a * a * a / (3 * effective) - std::sqrt(8 * pi * m.surface_energy * modulus * a * a * a);
}

double end_of_contact(const dem::Material& m, double effective) {
    const double ratio = pi * m.surface_energy / dem::effective_modulus(m);
    return -0.75 * std::cbrt(ratio * ratio * effective);
}

/// A contact that has lasted, of two spheres or of one and a wall.
template <dem::Partner partner>
dem::Touch<partner> touch(double effective, double overlap) {
    dem::Touch<partner> t;
    t.radius_i = partner == dem::Partner::wall ? effective : 2 * effective;
    t.radius_j = partner == dem::Partner::wall ? 0 : 2 * effective;
    t.effective_radius = effective;
    t.overlap = overlap;
    t.reduced_mass = 1e-10;
    t.normal = {1, 0, 0};
    return t;
}

using JkrContact = dem::Contact<double, dem::Hertz, dem::Jkr>;

/// Relative speed after an impact, 0: they stick.
double rebound(const dem::Material& material, double speed, Method::Precision precision) {
    const double step = 1e-9;
    const auto engine = dem::make_engine(pair_of(material, 5e-9, speed, step), method(precision));
    for (int k = 0; k < 400; ++k) {
        engine->run(500);
        const auto s = tests::state_of(*engine);
        if (s.position[1][0] - s.position[0][0] > 2 * radius + 1e-8) return s.velocity[1][0] - s.velocity[0][0];
    }
    EXPECT_EQ(engine->fault(), "");
    return 0;
}

TEST(Jkr, HasTheRadiusAndForceOfTheLargestRoot) {
    for (const double w : {1e-6, 1e-3, 0.1})
        for (const double effective : {1e-6, radius / 2, 1e-3}) {
            const auto m = powder(CohesionLaw::jkr, w);
            const auto contact = JkrContact::of(m);
            const double end = end_of_contact(m, effective);
            for (const double part : {-0.999, -0.9, -0.5, -1e-3, 0.0, 1e-6, 0.01, 1.0, 30.0}) {
                const double overlap = part * -end;
                auto t = touch<dem::Partner::particle>(effective, overlap);
                double lasting = 1;
                contact.begin(t, &lasting);
                ASSERT_TRUE(t.touching) << part;
                const double a = contact_radius(m, effective, overlap);
                EXPECT_NEAR(t.root / a, 1, 1e-10) << w << ' ' << effective << ' ' << part;
                const double scale = 1.5 * pi * w * effective;
                EXPECT_NEAR((contact.respond<true>(t, &lasting).normal - force(m, effective, a)) / scale, 0,
                            1e-10 * (1 + std::pow(std::max(part, 1.0), 1.5)));
                EXPECT_EQ(lasting, 1);
            }
        }
}

TEST(Jkr, BeginsAtTouchAndEndsAtItsDistance) {
    const auto m = powder(CohesionLaw::jkr, 0.01);
    const auto contact = JkrContact::of(m);
    const double effective = radius / 2, end = end_of_contact(m, effective);
    EXPECT_NEAR(JkrContact::beyond(m, effective) / -end, 1, 1e-14);
    const auto holds = [&](double overlap, double lasting) {
        auto t = touch<dem::Partner::particle>(effective, overlap);
        contact.begin(t, &lasting);
        return t.touching;
    };
    EXPECT_FALSE(holds(-1e-15, 0));
    EXPECT_TRUE(holds(1e-15, 0));
    EXPECT_TRUE(holds(end * (1 - 1e-10), 1));
    EXPECT_FALSE(holds(end * (1 + 1e-10), 1));
    // The largest attraction, -3/2 pi w R*, is where dF/da = 0: y^3 = 1/2.
    double least = 0;
    for (double part = -1; part < 1; part += 1e-4) {
        auto t = touch<dem::Partner::particle>(effective, part * -end);
        double lasting = 1;
        contact.begin(t, &lasting);
        if (t.touching) least = std::min(least, contact.respond<false>(t, &lasting).normal);
    }
    EXPECT_NEAR(least / (1.5 * pi * 0.01 * effective), -1, 1e-7);
    // at the end 5/9 of it are left
    auto t = touch<dem::Partner::particle>(effective, end * (1 - 1e-12));
    double lasting = 1;
    contact.begin(t, &lasting);
    EXPECT_NEAR(contact.respond<false>(t, &lasting).normal / (1.5 * pi * 0.01 * effective), -5.0 / 9, 1e-5);
    // by the exact radius at the pull-off force
    const double a0 = std::cbrt(4.5 * pi * 0.01 * effective * effective / dem::effective_modulus(m));
    const double y3 = 0.5, y = std::cbrt(y3);
    auto at_least = touch<dem::Partner::particle>(effective, a0 * a0 / effective * (y * y3 - 2.0 / 3 * y));
    contact.begin(at_least, &lasting);
    EXPECT_NEAR(contact.respond<false>(at_least, &lasting).normal / (-1.5 * pi * 0.01 * effective), 1, 1e-10);
}

TEST(Jkr, StoresTheWorkOfItsForce) {
    const auto m = powder(CohesionLaw::jkr, 0.02);
    const auto contact = JkrContact::of(m);
    const double effective = radius, end = end_of_contact(m, effective);
    const auto at = [&](double overlap, auto&& what) {
        auto t = touch<dem::Partner::wall>(effective, overlap);
        double lasting = 1;
        contact.begin(t, &lasting);
        EXPECT_TRUE(t.touching);
        return what(t, &lasting);
    };
    const auto energy = [&](double overlap) {
        return at(overlap, [&](const auto& t, double* memory) { return contact.energy(t, memory); });
    };
    for (const double part : {-0.9, -0.3, 0.1, 2.0, 20.0}) {
        const double h = 1e-4 * -end, overlap = part * -end;
        const double slope = (energy(overlap + h) - energy(overlap - h)) / (2 * h);
        const double normal =
            at(overlap, [&](const auto& t, double* memory) { return contact.respond<false>(t, memory).normal; });
        EXPECT_NEAR(slope, normal, 2e-6 * pi * 0.02 * effective * (1 + std::pow(std::max(part, 1.0), 1.5)));
    }
    const double modulus = dem::effective_modulus(m);
    const double scale = std::cbrt(std::pow(0.02, 5) * std::pow(effective, 4) / (modulus * modulus));
    EXPECT_NEAR(energy(end * (1 - 1e-13)) / scale, 0, 1e-6);
    EXPECT_NEAR(energy(0) / scale, -7.09, 0.005);  // Thornton & Ning (1998), eq. 34
}

// Without damping an impact loses what touch releases, 7.09 (w^5 R*^4/E*^2)^(1/3), and slower ones stick:
// e^2 = 1 - (v_s/v)^2. The step resolves the end of the contact, where the force breaks off, to first order.
TEST(Jkr, SticksBelowItsSpeedAndReboundsAbove) {
    const auto m = powder(CohesionLaw::jkr, 1e-3);
    const double effective = radius / 2, modulus = dem::effective_modulus(m);
    const double reduced = dem::sphere_mass(radius, m.density) / 2;
    const double released = 7.0909 * std::cbrt(std::pow(1e-3, 5) * std::pow(effective, 4) / (modulus * modulus));
    const double sticking = std::sqrt(2 * released / reduced);
    for (const auto precision : both) {
        for (const double ratio : {0.9, 0.98}) EXPECT_EQ(rebound(m, ratio * sticking, precision), 0) << ratio;
        for (const double ratio : {1.05, 1.5, 4.0}) {
            const double expected = std::sqrt(1 - 1 / (ratio * ratio));
            EXPECT_NEAR(rebound(m, ratio * sticking, precision) / (ratio * sticking), expected, 4e-3) << ratio;
        }
    }
}

TEST(Dmt, PullsConstantlyWhileItTouches) {
    const auto m = powder(CohesionLaw::dmt, 0.01);
    const auto contact = dem::Contact<double, dem::Hertz, dem::Dmt>::of(m);
    const double effective = 2e-5;
    auto t = touch<dem::Partner::particle>(effective, 1e-8);
    t.root = std::sqrt(effective * t.overlap);
    const double hertz = 4.0 / 3 * dem::effective_modulus(m) * t.root * t.overlap;
    const double pull_off = 2 * pi * 0.01 * effective;
    EXPECT_NEAR(contact.respond<true>(t, nullptr).normal, hertz - pull_off, 1e-10 * pull_off);
    EXPECT_NEAR(contact.energy(t, nullptr), 0.4 * hertz * t.overlap - pull_off * t.overlap, 1e-10 * pull_off * 1e-8);
}

// At a wall, R* = R, both engines rest at the overlap where the force vanishes.
TEST(Adhesion, RestsWhereTheForceVanishes) {
    for (const auto law : {CohesionLaw::jkr, CohesionLaw::dmt})
        for (const auto precision : both) {
            auto m = powder(law, 2e-3);
            m.restitution = 0.2;
            auto s = pair_of(m, 1e-8, 0.002, 1e-9);
            const auto engine = dem::make_engine(s, method(precision));
            engine->run(300000);
            ASSERT_EQ(engine->fault(), "");
            const auto state = tests::state_of(*engine);
            const double overlap = 2 * radius - state.position[1][0] + state.position[0][0];
            const double effective = radius / 2, modulus = dem::effective_modulus(m);
            // JKR: y^3 = 1, a = a_0, d = a_0^2/(3 R*).  DMT: 4/3 E* sqrt(R*) d^1.5 = 2 pi w R*
            const double expected =
                law == CohesionLaw::jkr
                    ? std::pow(4.5 * pi * 2e-3 * effective * effective / modulus, 2.0 / 3) / (3 * effective)
                    : std::pow(1.5 * pi * 2e-3 * std::sqrt(effective) / modulus, 2.0 / 3);
            EXPECT_NEAR(overlap / expected, 1, precision == Method::Precision::mixed ? 1e-4 : 1e-6);
            std::vector<dem::ContactForce> contacts;
            engine->contacts(contacts);
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_NEAR(contacts[0].normal_force / (pi * 2e-3 * effective), 0, 1e-3);
        }
}

// The clear engine against the law written down plainly, through rebuilds of lists, at walls, with friction and both
// rolling laws; and what it saves goes on bit for bit among contacts that last beyond touch.
TEST(Adhesion, ManySpheresAsPlainly) {
    for (const auto law : {CohesionLaw::jkr, CohesionLaw::dmt})
        for (const auto rolling : {dem::RollingLaw::epsd, dem::RollingLaw::cdt}) {
            dem::Setup s = tests::boxed_lattice(4, 0.3, 0.25, 15);
            s.material.cohesion_law = law;
            s.material.surface_energy = 2;
            s.material.rolling_friction = 0.1;
            s.material.rolling_law = rolling;
            tests::PlainDem plain(s);
            plain.run(400);
            const auto engine = dem::make_engine(s, {});
            engine->run(250);
            std::vector<std::byte> saved;
            engine->save(saved);
            engine->run(150);
            ASSERT_EQ(engine->fault(), "");
            const auto state = tests::state_of(*engine);
            double worst = 0;
            for (std::size_t k = 0; k < state.id.size(); ++k)
                for (std::size_t a = 0; a < 3; ++a)
                    worst = std::max(worst, std::abs(state.position[k][a] -
                                                     plain.position()[static_cast<std::size_t>(state.id[k])][a]));
            EXPECT_LT(worst, 1e-10 * 2e-3) << static_cast<int>(law) << static_cast<int>(rolling);
            const auto again = dem::make_engine(s, {});
            again->restore(saved);
            again->run(150);
            EXPECT_EQ(tests::state_of(*again).position, state.position);
            EXPECT_EQ(tests::state_of(*again).velocity, state.velocity);
        }
}

// A force that begins with attraction gives energy to the particles that comes from nowhere in their motion: the energy
// of all, with what contacts hold, only falls when two meet.
TEST(Adhesion, TheEngineFindsNoEnergyFromNowhere) {
    for (const auto precision : both) {
        dem::Setup s = tests::thrown_lattice(5, 0.3, 0.25, 16);
        s.material.cohesion_law = CohesionLaw::jkr;
        s.material.surface_energy = 2;
        s.material.restitution = 1;
        s.material.friction = 0;
        const auto engine = dem::make_engine(s, method(precision));
        engine->run(4000);
        EXPECT_EQ(engine->fault(), "");
        std::vector<dem::ContactForce> contacts;
        engine->contacts(contacts);
        EXPECT_TRUE(std::ranges::any_of(contacts, [](const auto& c) { return c.overlap < 0; }))
            << "some last beyond touch";
    }
}

}  // namespace grainsweep::tests::dem_adhesion_test
