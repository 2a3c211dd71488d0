// Impacts in gross sliding: whatever the restitution and the time step, the tangential impulse is mu times the normal
// one, as of rigid bodies with Coulomb friction, and no tangential force exceeds mu times a normal force that repels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "solver/dem/time_step.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"

namespace grainsweep::tests::dem_gross_sliding_test {

using namespace geometry;
using dem::Method;
using dem::NormalLaw;
using dem::TangentialLimit;

constexpr Method engines[] = {{Method::Precision::double_precision}, {Method::Precision::mixed}};
constexpr double radius = sphere_at_walls, friction = 0.15, speed = 0.5;
constexpr double restitutions[] = {1.0, 0.9, 0.7, 0.5, 0.3, 0.2};

/// Impulses of an impact, N s; along the normal and against the slip of each step.
struct Impulses {
    double normal = 0, repelling = 0, tangential = 0, exceeding = 0;
    double dissipated = 0;      ///< J
    double work = 0;            ///< of the walls, J
    double largest_moment = 0;  ///< over R* times the normal force of its step
    dem::State state;
    [[nodiscard]] double ratio() const { return tangential / (friction * normal); }
};

Impulses impact(const dem::Setup& setup, const Method& method) {
    const auto engine = dem::make_engine(setup, method);
    std::vector<dem::ContactForce> contacts;
    Impulses sum;
    for (int step = 0, touched = 0; step < 40000; ++step) {
        engine->run(1);
        engine->step_contacts(contacts);
        if (contacts.empty() && touched > 0) break;
        for (const auto& c : contacts) {
            ++touched;
            const double force = norm(c.tangential_force), most = friction * std::max(c.normal_force, 0.0);
            sum.normal += c.normal_force * setup.time_step;
            sum.repelling += std::max(c.normal_force, 0.0) * setup.time_step;
            sum.tangential += force * setup.time_step;
            sum.exceeding = std::max(sum.exceeding, force - most);
            sum.dissipated += (c.normal_power + c.tangential_power) * setup.time_step;
            if (c.normal_force > 0)
                sum.largest_moment = std::max(sum.largest_moment, norm(c.rolling_moment) / (radius * c.normal_force));
        }
    }
    EXPECT_EQ(engine->fault(), "");
    EXPECT_GT(sum.normal, 0);
    sum.state = state_of(*engine);
    for (std::size_t w = 0; w < setup.walls.size(); ++w) sum.work += engine->wall_load(w, {}).work;
    return sum;
}

void prepare(dem::Setup& s, NormalLaw law, double restitution, double fraction, double phase = 0.4) {
    s.material.normal_law = law;
    s.material.youngs_modulus = 2e10;  // the contact turns little
    s.material.stiffness = law == NormalLaw::linear ? 1e7 : 0;
    s.material.friction = friction;
    s.material.restitution = restitution;
    s.time_step = fraction * dem::shortest_time(s.material, radius, speed);
    s.spheres[0].position[2] += phase * speed * s.time_step;
}

/// A sphere that slides over a plane, about to hit it.
dem::Setup above_plane() {
    return one_sphere({0, 0, radius}, {1, 0.5, -speed}, {dem::Plane{}});
}

/// Two equal spheres of which the upper one slides over the lower one.
dem::Setup above_sphere() {
    dem::Setup s = one_sphere({0, 0, radius}, {1, 0.5, -speed}, {});
    s.spheres.push_back({{0, 0, -radius}, {}, {}, radius, true});
    return s;
}

/// A sphere that falls on a plane which slides.
dem::Setup above_sliding_plane() {
    dem::Wall floor = dem::Plane{};
    floor.motions = {geometry::Translation{.velocity = {-1, 0, 0}}};
    return one_sphere({0, 0, radius}, {0, 0.5, -speed}, {floor});
}

struct Case {
    const char* name;
    dem::Setup (*setup)();
};
constexpr Case cases[] = {{"plane", above_plane}, {"pair", above_sphere}, {"sliding plane", above_sliding_plane}};

// Means over five phases of the step at touch. The tolerance is the error of the integration: the dashpot of a step has
// the velocity of half a step before, so that the normal impulse errs, and the last step ends beyond separation.
TEST(GrossSliding, HasTheImpulseOfCoulombsLawAtAnyRestitutionAndStep) {
    constexpr double phases[] = {0.1, 0.3, 0.5, 0.7, 0.9};
    for (const auto& [name, setup] : cases)
        for (const Method& method : engines)
            for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
                for (const double e : restitutions)
                    for (const auto& [fraction, tolerance] : {std::pair{0.2, 3.5e-2}, {0.05, 6e-3}, {0.01, 1.5e-3}}) {
                        double mean = 0;
                        for (const double phase : phases) {
                            dem::Setup s = setup();
                            prepare(s, law, e, fraction, phase);
                            const Impulses of = impact(s, method);
                            mean += of.ratio() / std::size(phases);
                            EXPECT_LT(of.exceeding, 1e-5 * of.normal / s.time_step) << name << " " << e;
                        }
                        EXPECT_NEAR(mean, 1, e == 1 ? 1e-4 : tolerance)
                            << name << " " << e << " " << fraction << " " << (law == NormalLaw::linear);
                    }
}

// The velocities after the impact, without the bookkeeping of the contacts: v_t' = v_t - mu (v_n + v_n'), R w' = 5/2 of
// the change.
TEST(GrossSliding, LeavesTheVelocitiesOfARigidSphere) {
    for (const Method& method : engines)
        for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
            for (const double e : restitutions) {
                dem::Setup s = above_plane();
                s.spheres[0].velocity = {1, 0, -speed};
                prepare(s, law, e, 0.01);
                const dem::State after = impact(s, method).state;
                const double slowed = friction * (speed + after.velocity[0][2]);
                EXPECT_NEAR(after.velocity[0][2] / speed, e, 5e-3) << e;
                EXPECT_NEAR((1 - after.velocity[0][0]) / slowed, 1, 2e-3) << e;
                EXPECT_NEAR(radius * after.angular_velocity[0][1] / (2.5 * slowed), 1, 2e-2)
                    << e << ", the arm R - d/2";
            }
}

// As LIGGGHTS: the dashpot slides on top of Coulomb's limit.
TEST(GrossSliding, ExceedsCoulombsLawWhereTheSpringAloneIsLimited) {
    for (const Method& method : engines)
        for (const auto& [e, ratio] : {std::pair{0.5, 1.1}, {0.3, 1.3}, {0.2, 1.5}}) {
            dem::Setup s = above_plane();
            prepare(s, NormalLaw::hertz, e, 0.01);
            s.material.tangential_limit = TangentialLimit::spring;
            EXPECT_GT(impact(s, method).ratio(), ratio) << e;
        }
}

TEST(GrossSliding, WithoutDampingBothLimitsHaveTheSameBits) {
    for (const auto& [name, setup] : cases)
        for (const Method& method : engines)
            for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
                for (const double slip : {1.0, 0.05}) {  // slides, sticks
                    dem::Setup s = setup();
                    s.spheres[0].velocity[0] *= slip;
                    prepare(s, law, 1, 0.1);
                    const dem::State sum = impact(s, method).state;
                    s.material.tangential_limit = TangentialLimit::spring;
                    const dem::State spring = impact(s, method).state;
                    EXPECT_EQ(sum.position, spring.position) << name << " " << slip;
                    EXPECT_EQ(sum.velocity, spring.velocity) << name << " " << slip;
                    EXPECT_EQ(sum.angular_velocity, spring.angular_velocity) << name << " " << slip;
                }
}

// A gas of damped spheres with walls: between two steps the kinetic energy at half steps changes by what contacts book.
TEST(GrossSliding, LosesTheEnergyThatContactsBook) {
    for (const double e : {0.9, 0.5, 0.2}) {
        dem::Setup s = above_plane();
        s.spheres[0].velocity = {1, 0, -speed};
        prepare(s, NormalLaw::hertz, e, 0.05);
        const double before = kinetic_energy(s, state_of(*dem::make_engine(s, engines[0])));
        for (const Method& method : engines) {
            const Impulses of = impact(s, method);
            const double lost = before - kinetic_energy(s, of.state);
            const double tolerance = method.precision == Method::Precision::mixed ? 1e-3 : 1e-9;
            EXPECT_NEAR(of.dissipated / lost, 1, tolerance) << e;
        }
    }
}

// From head-on to grazing impacts. By `spring` a step that cuts the spring has no dashpot, and beside it one may have a
// dashpot many times Coulomb's limit. The loss is known to the rounding of the motion, 1e-7 of its energy.
TEST(GrossSliding, BooksTheLossOfAnyImpact) {
    double worst[2] = {0, 0};
    for (const auto& [name, setup] : cases)
        for (const TangentialLimit limit : {TangentialLimit::sum, TangentialLimit::spring})
            for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
                for (const double rolling : {0.0, 0.1})
                    for (const double e : {0.1, 0.3, 0.6, 0.95})
                        for (const double angle : {20, 60, 80, 88, 89})
                            for (const double phase : {0.07, 0.31, 0.73}) {
                                dem::Setup s = setup();
                                s.material.rolling_friction = rolling;
                                s.material.tangential_limit = limit;
                                prepare(s, law, e, 0.1, phase);
                                s.spheres[0].velocity[0] *= speed * std::tan(angle * std::numbers::pi / 180);
                                const double before = kinetic_energy(s, state_of(*dem::make_engine(s, engines[0])));
                                for (const Method& method : engines) {
                                    const Impulses of = impact(s, method);
                                    const double lost = before + of.work - kinetic_energy(s, of.state);
                                    const bool mixed = method.precision == Method::Precision::mixed;
                                    const double error = std::abs(of.dissipated - lost);
                                    EXPECT_LT(error, mixed ? 1e-3 * lost + 1e-7 * before : 1e-9 * before)
                                        << name << " " << static_cast<int>(limit) << static_cast<int>(law) << " "
                                        << rolling << " " << e << " " << angle << " " << phase;
                                    worst[mixed ? 1 : 0] = std::max(worst[mixed ? 1 : 0], error / lost);
                                }
                            }
    RecordProperty("worst_double", std::to_string(worst[0]));
    RecordProperty("worst_mixed", std::to_string(worst[1]));
}

// Of bodies that attract each other, from head-on to grazing: they part at other places than they touch, or in the air.
TEST(GrossSliding, BooksTheLossOfStickyImpacts) {
    using dem::CohesionLaw;
    double worst[2] = {0, 0};
    for (const auto& [name, setup] : cases)
        for (const CohesionLaw law : {CohesionLaw::jkr, CohesionLaw::dmt, CohesionLaw::capillary, CohesionLaw::sjkr})
            for (const TangentialLimit limit : {TangentialLimit::sum, TangentialLimit::spring})
                for (const double e : {0.1, 0.5, 0.9})
                    for (const double angle : {0, 45, 80, 88})
                        for (const double phase : {0.07, 0.53}) {
                            dem::Setup s = setup();
                            prepare(s, NormalLaw::hertz, e, 0.1, phase);
                            s.material.tangential_limit = limit;
                            s.material.cohesion_law = law;
                            s.material.cohesion = law == CohesionLaw::sjkr ? 1e7 : 0;
                            s.material.surface_energy = law == CohesionLaw::jkr || law == CohesionLaw::dmt ? 2 : 0;
                            s.material.surface_tension = law == CohesionLaw::capillary ? 0.02 : 0;
                            s.spheres[0].velocity[0] *= speed * std::tan(angle * std::numbers::pi / 180);
                            s.spheres[0].velocity[1] *= angle > 0 ? 1 : 0;
                            const double before = kinetic_energy(s, state_of(*dem::make_engine(s, engines[0])));
                            for (const Method& method : engines) {
                                const Impulses of = impact(s, method);
                                const double lost = before + of.work - kinetic_energy(s, of.state);
                                const bool mixed = method.precision == Method::Precision::mixed;
                                const double error = std::abs(of.dissipated - lost);
                                EXPECT_LT(error, mixed ? 1e-3 * lost + 1e-7 * before : 1e-9 * before)
                                    << name << " " << static_cast<int>(law) << static_cast<int>(limit) << " " << e
                                    << " " << angle << " " << phase;
                                worst[mixed ? 1 : 0] = std::max(worst[mixed ? 1 : 0], error / lost);
                            }
                        }
    RecordProperty("worst_double", std::to_string(worst[0]));
    RecordProperty("worst_mixed", std::to_string(worst[1]));
}

// A belt that starts under a resting sphere, at the start or later, pulls it by mu times its weight from the first step
// on, although it slips there with the whole speed of the belt. By `spring` the dashpot of the first half step is not
// limited, as in LIGGGHTS.
TEST(GrossSliding, StartsABeltWithinCoulombsLaw) {
    constexpr double gravity = 9.81;
    for (const Method& method : engines)
        for (const TangentialLimit limit : {TangentialLimit::sum, TangentialLimit::spring})
            for (const bool later : {false, true}) {
                dem::Setup s = one_sphere({0, 0, radius}, {}, {dem::Plane{}});
                s.material.youngs_modulus = 1e7;
                s.material.friction = friction;
                s.material.tangential_limit = limit;
                s.gravity = {0, 0, -gravity};
                s.time_step = 0.1 * dem::shortest_time(s.material, radius, 0.1);
                const double stiffness = 4.0 / 3 * dem::effective_modulus(s.material) * std::sqrt(radius);
                s.spheres[0].position[2] -=
                    std::pow(dem::sphere_mass(radius, s.material.density) * gravity / stiffness, 2.0 / 3);
                const std::vector<dem::Wall> rests = s.walls;
                dem::Wall belt = rests[0];
                belt.motions = {geometry::Translation{.velocity = {1, 0, 0}}};
                if (!later) s.walls = {belt};
                const auto engine = dem::make_engine(s, method);
                if (later) {
                    engine->run(100);
                    std::get<geometry::Translation>(belt.motions[0]).start = engine->wall_time();
                    engine->change_walls({belt});
                }
                double before = state_of(*engine).velocity[0][0], most = 0;
                for (int step = 0; step < 20; ++step) {
                    engine->run(1);
                    const double now = state_of(*engine).velocity[0][0];
                    most = std::max(most, (now - before) / (friction * gravity * s.time_step));
                    before = now;
                }
                if (limit == TangentialLimit::sum)
                    EXPECT_NEAR(most, 1, 1e-2) << later;
                else
                    EXPECT_GT(most, 10) << later;
            }
}

// Rolling moments likewise: mu_r R* times the normal force that friction sees, with the dashpot.
TEST(GrossSliding, LimitsRollingMomentsWithTheirDashpot) {
    for (const Method& method : engines)
        for (const NormalLaw law : {NormalLaw::hertz, NormalLaw::linear})
            for (const auto rolling : {dem::RollingLaw::epsd, dem::RollingLaw::epsd_liggghts, dem::RollingLaw::cdt})
                for (const double e : restitutions) {
                    dem::Setup s = above_plane();
                    s.spheres[0].angular_velocity = {300, -200, 0};
                    s.material.rolling_friction = 0.1;
                    s.material.rolling_law = rolling;
                    prepare(s, law, e, 0.01);
                    const Impulses of = impact(s, method);
                    EXPECT_NEAR(of.ratio(), 1, 1.5e-3) << e;
                    if (rolling == dem::RollingLaw::cdt) continue;  // of the elastic force
                    EXPECT_LT(of.largest_moment, 0.1 * (1 + 2e-5)) << e;
                    s.material.tangential_limit = TangentialLimit::spring;
                    EXPECT_GT(impact(s, method).largest_moment, 0.11) << e;
                }
}

}  // namespace grainsweep::tests::dem_gross_sliding_test
