#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/limits.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/dem/walls/moving_wall.hpp"
#include "tests/support/blade.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::dem_laws_test {

using namespace dem;
using std::numbers::pi;

/// Spheres of radii 2 and 1 mm, overlap 0.02 mm.
Touch<Partner::particle> pair(double normal_velocity = 0) {
    Touch<Partner::particle> t;
    t.radius_i = 0.002;
    t.radius_j = 0.001;
    t.overlap = 2e-5;
    t.distance = 0.003 - 2e-5;
    t.effective_radius = 0.002 / 3;
    t.reduced_mass = 1e-5;
    t.root = std::sqrt(t.effective_radius * t.overlap);
    t.damping_root = std::sqrt(t.root * t.reduced_mass);
    t.normal = {0, 0, 1};
    t.normal_velocity = normal_velocity;
    return t;
}

Touch<Partner::wall> wall() {
    Touch<Partner::wall> t;
    t.radius_i = t.effective_radius = 0.002;
    t.overlap = 2e-5;
    return t;
}

TEST(Material, DerivesTheEffectiveModuli) {
    const Material m;  // E 21 MPa, nu 0.3
    EXPECT_NEAR(effective_modulus(m), 21e6 / 1.82, 1e-6);
    EXPECT_NEAR(effective_shear_modulus(m), 21e6 / (4 * 1.7 * 1.3), 1e-6);
    EXPECT_EQ(damping_ratio(1), 0);
    EXPECT_NEAR(damping_ratio(0.5), -0.21545376, 1e-8);
    EXPECT_NEAR(sphere_mass(0.001, 7980), 3.34265e-5, 1e-10);
}

TEST(Hertz, IsTheSpringAndTheDamperOfItsFormula) {
    const Material m;
    const auto contact = Contact<double, Hertz>::of(m);
    const auto t = pair();
    const double stiffness = 4.0 / 3.0 * effective_modulus(m) * std::sqrt(t.effective_radius * t.overlap);
    EXPECT_NEAR(contact.respond<true>(t, nullptr).normal, stiffness * t.overlap, 1e-15);
    const double s_n = 2 * effective_modulus(m) * std::sqrt(t.effective_radius * t.overlap);
    const double g_n = -2 * std::sqrt(5.0 / 6.0) * damping_ratio(0.5) * std::sqrt(s_n * t.reduced_mass);
    EXPECT_NEAR(contact.respond<true>(pair(0.3), nullptr).normal, stiffness * t.overlap - 0.3 * g_n, 1e-12);
    // The stored energy is the work of the spring.
    EXPECT_NEAR(contact.energy(t, nullptr), 0.4 * stiffness * t.overlap * t.overlap, 1e-18);
}

TEST(Linear, IsTheSpringsAndDampersOfItsFormula) {
    Material m;
    m.normal_law = NormalLaw::linear;
    m.stiffness = 1000;
    m.tangential_ratio = 0.4;
    m.friction = 0.3;
    m.rolling_friction = 0.2;
    const auto contact = Contact<double, Linear, LinearSliding, LinearRolling>::of(m);
    auto t = pair(0.01);
    t.time_step = 1e-6;
    t.slip = {0.01, 0, 0};
    t.turning = {2, 0, 0};
    t.rolling_inertia = 1e-12;
    const double g = -2 * damping_ratio(0.5) * std::sqrt(1000 * t.reduced_mass);
    std::array<double, 6> memory{1e-7, 0, 5e-8};
    const auto r = contact.respond<true>(t, memory.data());
    EXPECT_NEAR(r.elastic, 1000 * t.overlap, 1e-15);
    EXPECT_NEAR(r.normal, 1000 * t.overlap - g * 0.01, 1e-15);
    EXPECT_NEAR(memory[0], 1.1e-7, 1e-20);
    EXPECT_NEAR(r.resistance[0], 400 * 1.1e-7 + 0.4 * g * 0.01, 1e-15);
    const double k_r = 2.25 * 0.04 * 1000 * t.effective_radius * t.effective_radius;
    EXPECT_NEAR(memory[3], k_r * 2e-6, 1e-20);
    EXPECT_NEAR(contact.energy(t, memory.data()),
                500 * t.overlap * t.overlap + 200 * 1.1e-7 * 1.1e-7 + 0.5 * memory[3] * memory[3] / k_r, 1e-18);
    m.tangential_damping = 0.1;
    std::array<double, 6> none{};
    t.time_step = 0;
    EXPECT_NEAR(
        (Contact<double, Linear, LinearSliding, LinearRolling>::of(m).respond<true>(t, none.data()).resistance[0]),
        0.1 * g * 0.01, 1e-15);
}

TEST(Mindlin, SticksAsASpringAndSlidesAtCoulombsLimit) {
    Material m;
    m.friction = 0.3;
    const auto contact = Contact<double, Hertz, Mindlin>::of(m);
    auto t = pair();
    t.time_step = 1e-6;
    const double normal = 4.0 / 3.0 * effective_modulus(m) * t.root * t.overlap;
    const double k_t = 8 * effective_shear_modulus(m) * t.root;
    const double g_t = -2 * std::sqrt(5.0 / 6.0) * damping_ratio(0.5) * std::sqrt(k_t * t.reduced_mass);
    Vec3 s{1e-7, 0, 5e-8};
    t.slip = {0.01, 0, 0};
    const auto sticking = contact.respond<true>(t, s.data());
    EXPECT_NEAR(s[0], 1e-7 + 1e-8, 1e-20);
    EXPECT_EQ(s[2], 0);  // only the tangential part stays
    EXPECT_NEAR(sticking.resistance[0], k_t * 1.1e-7 + g_t * 0.01, 1e-12);
    Vec3 far{1e-3, 0, 0};
    const auto sliding = contact.respond<true>(t, far.data());
    EXPECT_NEAR(sliding.resistance[0], 0.3 * normal, 1e-14);
    EXPECT_NEAR(far[0], 0.3 * normal / k_t, 1e-18);  // cut back to the elastic limit
    Vec3 still{1e-3, 0, 0};
    (void)contact.respond<false>(t, still.data());
    EXPECT_EQ(still[0], 1e-3);  // looking does not touch the memory
}

TEST(Cohesion, HasThreeAreas) {
    const auto t = pair();
    const double r = t.distance;
    const auto area = [](CohesionLaw law, const auto& touch) {  // by the attraction of 1 J/m3
        Material m;
        m.cohesion = 1;
        m.cohesion_law = law;
        Response<double> response;
        Cohesion<double>(Contact<double, Cohesion>::values_of(m).data()).add<true>(touch, response, nullptr);
        if (law == CohesionLaw::sjkr) {
            Response<double> lean;
            LensCohesion<double>(Contact<double, LensCohesion>::values_of(m).data()).add<true>(touch, lean, nullptr);
            EXPECT_EQ(lean.normal, response.normal);
        }
        EXPECT_EQ(response.seen, 0);
        return -response.normal;
    };
    // The disc where two spheres cut, from its elementary geometry.
    const double offset = (r * r + 0.002 * 0.002 - 0.001 * 0.001) / (2 * r);
    EXPECT_NEAR(area(CohesionLaw::sjkr, t), pi * (0.002 * 0.002 - offset * offset), 1e-17);
    EXPECT_NEAR(area(CohesionLaw::sjkr2, t), 4 * pi * t.effective_radius * t.overlap, 1e-20);
    EXPECT_NEAR(area(CohesionLaw::paper, t), pi / 4 * (2 * t.effective_radius - t.overlap) * t.overlap, 1e-20);
    EXPECT_NEAR(area(CohesionLaw::sjkr, wall()), pi * (2 * 0.002 - 2e-5) * 2e-5, 1e-20);
    EXPECT_NEAR(area(CohesionLaw::sjkr2, wall()), 2 * pi * 0.002 * 2e-5, 1e-20);
    EXPECT_NEAR(area(CohesionLaw::paper, wall()), pi / 4 * (2 * 0.002 - 2e-5) * 2e-5, 1e-20);
}

TEST(Contact, TheMaterialDecidesWhatFrictionSees) {
    Material m;
    m.friction = 0.3;
    m.cohesion = 1e4;
    const auto t = pair();
    const auto response = [&](FrictionLimit limit) {
        m.friction_limit = limit;
        Vec3 s{1e-3, 0, 0};
        return Contact<double, Hertz, Cohesion, Mindlin>::of(m).respond<true>(t, s.data());
    };
    const auto contact_force = response(FrictionLimit::contact), net = response(FrictionLimit::net);
    const double attraction = 1e4 * 2 * pi * t.effective_radius * t.overlap;
    EXPECT_EQ(contact_force.normal, net.normal);
    EXPECT_NEAR(contact_force.seen - contact_force.normal, attraction, 0.01 * attraction);
    EXPECT_NEAR(contact_force.resistance[0], 0.3 * contact_force.seen, 1e-14);
    EXPECT_NEAR(net.resistance[0], 0.3 * net.normal, 1e-14);
}

TEST(Contact, NeedsWhatItsLawsNeed) {
    static_assert(!Contact<double, Hertz>::spin && !Contact<double, Hertz>::remembers);
    static_assert(Contact<double, Hertz, Mindlin>::spin && Contact<double, Hertz, Mindlin>::memories == 3);
    static_assert(!Contact<double, Hertz, LensCohesion>::spin);
    static_assert(Contact<double, Hertz, Mindlin, RollingResistance>::rolls);
    static_assert(Contact<double, Hertz, Mindlin, RollingResistance>::memories == 6);
}

TEST(Compiled, TheFirstCombinationThatFitsIsTaken) {
    const auto chosen = [](auto&& change) {
        Material m;
        change(m);
        return choose_combination(std::vector{m}, [](const CombinationFacts&) { return true; });
    };
    EXPECT_EQ(chosen([](Material& m) { m.friction = 0; }), 0);
    EXPECT_EQ(chosen([](Material&) {}), 1);
    EXPECT_EQ(chosen([](Material& m) { m.cohesion = 1; }), 2);
    EXPECT_EQ(chosen([](Material& m) { m.cohesion = 1, m.friction = 0; }), 3);
    EXPECT_EQ(chosen([](Material& m) { m.cohesion = 1, m.cohesion_law = CohesionLaw::paper; }), 3);
    EXPECT_EQ(chosen([](Material& m) { m.cohesion = 1, m.friction_limit = FrictionLimit::net; }), 3);
    const auto rolling = [](RollingLaw law) {
        return [law](Material& m) { m.rolling_friction = 0.1, m.rolling_law = law; };
    };
    EXPECT_EQ(chosen(rolling(RollingLaw::cdt)), 4);
    EXPECT_EQ(chosen(rolling(RollingLaw::epsd)), combinations() - 1);
    EXPECT_EQ(chosen([&](Material& m) { rolling(RollingLaw::cdt)(m), m.cohesion = 1; }), combinations() - 2);
    const auto adhesive = [&](CohesionLaw law, RollingLaw of_rolling) {
        return chosen([&](Material& m) { rolling(of_rolling)(m), m.cohesion_law = law, m.surface_energy = 1; });
    };
    EXPECT_EQ(adhesive(CohesionLaw::jkr, RollingLaw::epsd), 5);
    EXPECT_EQ(adhesive(CohesionLaw::jkr, RollingLaw::cdt), 6);
    EXPECT_EQ(adhesive(CohesionLaw::dmt, RollingLaw::epsd), 7);
    EXPECT_EQ(adhesive(CohesionLaw::dmt, RollingLaw::cdt), 8);
    EXPECT_EQ(chosen([](Material& m) { m.cohesion_law = CohesionLaw::jkr; }), 1) << "without surface energy";
    const auto wet = [&](RollingLaw of_rolling) {
        return chosen([&](Material& m) {
            rolling(of_rolling)(m), m.cohesion_law = CohesionLaw::capillary, m.surface_tension = 0.07,
                                    m.bridge_volume = 0.01;
        });
    };
    EXPECT_EQ(wet(RollingLaw::epsd), 9);
    EXPECT_EQ(wet(RollingLaw::cdt), 10);
    const auto linear = [&](auto&& change) {
        return chosen([&](Material& m) { m.normal_law = NormalLaw::linear, m.stiffness = 1, change(m); });
    };
    EXPECT_EQ(linear([](Material&) {}), 11);
    EXPECT_EQ(linear([](Material& m) { m.cohesion = 1; }), 12);
    EXPECT_EQ(linear(rolling(RollingLaw::cdt)), 12);
    EXPECT_EQ(linear(rolling(RollingLaw::epsd)), 13);
    Material plain;  // of many sizes only some are compiled
    plain.friction = 0;
    EXPECT_EQ(
        choose_combination(std::vector{plain}, [](const CombinationFacts& f) { return f.columns != Columns::equal; }),
        3);
}

TEST(TimeStep, LimitsAreThoseOfThePapers) {
    const Material m;
    EXPECT_NEAR(rayleigh_time(m, 0.0005), 5.3e-5, 0.1e-5);  // dt = 1e-5 is 0.19 of it at 1 mm
    EXPECT_NEAR(rayleigh_time(m, 0.001) / rayleigh_time(m, 0.0005), 2, 1e-12);
    EXPECT_NEAR(hertz_contact_time(m, 0.001, 3.2) / hertz_contact_time(m, 0.001, 0.1), 0.5, 1e-12);
    EXPECT_EQ(shortest_time(m, 0.001, 0.1), std::min(rayleigh_time(m, 0.001), hertz_contact_time(m, 0.001, 0.1)));
    Material linear = m;
    linear.normal_law = NormalLaw::linear;
    linear.stiffness = 1e4;
    EXPECT_NEAR(shortest_time(linear, 0.001, 0.1), 0.25 * pi * std::sqrt(sphere_mass(0.001, 7980) / 2 / 1e4), 1e-15);
}

TEST(MovingWall, MotionsThatFollowOneAnotherDoNotAddUpToAFasterWall) {
    const geometry::Domain domain{{-1, -1, -1}, {1, 1, 1}, {}};
    const auto fastest = [&](std::vector<geometry::Motion> motions) {
        return MovingWall(Wall(geometry::Plane{{0, 0, 0}, {0, 0, 1}}, std::move(motions)), domain, 1e-3).fastest();
    };
    const geometry::Translation up{{0, 0, 0.3}, 0, 1}, later{{0, 0, -0.4}, 1, 2}, always{{0, 0, 0.2}};
    EXPECT_NEAR(fastest({up, later}), 0.4, 1e-12);
    EXPECT_NEAR(fastest({later, up, always}), 0.6, 1e-12);
    EXPECT_NEAR(fastest({up, always}), 0.5, 1e-12);
}

TEST(MovingWall, ABladeFollowsItsLaw) {
    const Wall blade = Blade{0.015, 0.005, 0.002, 0.15, 1.4, 1e-4, 50, 0};
    MovingWall moving(blade, {{-1, -1, -1}, {1, 1, 1}, {}}, 1e-3);
    const double t = 0.003;
    moving.place(t);
    EXPECT_NEAR(moving.pose().shift[0], 1.4 * t, 1e-15);
    EXPECT_NEAR(moving.pose().shift[2], 1e-4 * std::sin(2 * pi * 50 * t), 1e-15);
    const double h = 1e-6;
    const auto v = moving.twist().velocity;
    EXPECT_NEAR(v[2], (moving.pose_at(t + h).shift[2] - moving.pose_at(t - h).shift[2]) / (2 * h), 1e-7);
    EXPECT_GE(moving.fastest(), std::hypot(v[0], v[2]));
    std::vector<WallTouch> touched;
    moving.find(7, {0.0155 + 1.4 * t, 0.3, 0.05}, 1e-3, touched);
    ASSERT_EQ(touched.size(), 1U);
    EXPECT_EQ(touched[0].entry, 7U);
    EXPECT_NEAR(touched[0].place.distance, 0.5e-3, 1e-12);
}

}  // namespace grainsweep::tests::dem_laws_test
